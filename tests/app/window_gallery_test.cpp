// The gallery under Xvfb, played by a script that all tests look at (window_gallery_test.sh).

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/image_io.hpp"
#include "tests/app/program.hpp"
#include "tests/app/window_pictures.hpp"
#include "tests/scenes/gltf_builder.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using test::read_text;

class WindowGalleryTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::Folder;
    test::GltfBuilder scene = test::good_scene();
    scene.document.erase("animations");
    scene.add_motion(1, "translation", {0.0F, 1.0F}, {0.0F, 0.13F, 0.0F, 0.0F, 0.09F, 0.0F});
    test::write_text(*folder_ / "looping.gltf", scene.text());
    scene.document["scenes"][0]["extras"]["torsion_loop"] = false;
    test::write_text(*folder_ / "once.gltf", scene.text());
    const std::string command = "xvfb-run -a -s '-screen 0 1280x720x24' " + test::source_folder() +
                                "/tests/app/window_gallery_test.sh " + test::build_folder() +
                                "/torsion " + (*folder_ / "looping.gltf") + " " +
                                (*folder_ / "once.gltf") + " " + (*folder_ / ".") + " > " +
                                (*folder_ / "log") + " 2>&1";
    status_ = std::system(command.c_str());  // NOLINT(cert-env33-c,concurrency-mt-unsafe): a script
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    ASSERT_EQ(status_, 0) << read_text(*folder_ / "log") << read_text(*folder_ / "bare.err")
                          << read_text(*folder_ / "session.err");
  }

  /// The share of the scene's part of the window that differs.
  static double changed(const std::string& a, const std::string& b) {
    const Result<Image> before = read_png(*folder_ / (a + ".png"));
    const Result<Image> after = read_png(*folder_ / (b + ".png"));
    EXPECT_TRUE(before.ok() && after.ok());
    return before && after ? test::changed(before.value(), after.value(), 330, 150, 1030, 620)
                           : 0.0;
  }

  static test::Folder* folder_;
  static int status_;
};
test::Folder* WindowGalleryTest::folder_ = nullptr;
int WindowGalleryTest::status_ = -1;

TEST_F(WindowGalleryTest, ASceneBeginsAgainUnlessItSaysOtherwise) {
  const auto session = [](const std::string& name) {
    return nlohmann::json::parse(read_text(*folder_ / name));
  };
  // A second and half a one of rest; the window may open late, and never begins twice at once.
  const nlohmann::json looping = session("looping.json");
  EXPECT_GE(looping["loops"].get<double>(), 1.0);
  EXPECT_LE(looping["loops"].get<double>(), looping["seconds"].get<double>() / 1.5);
  EXPECT_EQ(session("once.json")["loops"].get<int>(), 0);
}

TEST_F(WindowGalleryTest, EveryCardShowsAnotherScene) {
  EXPECT_GT(changed("first", "third"), 0.2);
  EXPECT_GT(changed("third", "fourth"), 0.2);
}

TEST_F(WindowGalleryTest, ValidationLayersAreSilent) {
  const std::string out = read_text(*folder_ / "session.json");
  EXPECT_EQ(out.find("VUID"), std::string::npos) << out;
  EXPECT_EQ(out.find("SYNC-HAZARD"), std::string::npos) << out;
  EXPECT_EQ(out.find("Validation"), std::string::npos) << out;
}

}  // namespace
}  // namespace torsion::engine
