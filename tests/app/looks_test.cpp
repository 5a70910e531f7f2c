// The scenes that look like what they are, by the program, against tests/images. To draw them anew:
// TORSION_UPDATE_IMAGES=1 program_tests --gtest_filter='Looks*', look at each, and say in the
// commit why it changed.

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "render/image_io.hpp"
#include "tests/app/program.hpp"
#include "tests/support/image_compare.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

class LooksTest : public testing::TestWithParam<const char*> {};

TEST_P(LooksTest, AreAsTheyWere) {
  const test::Folder folder;
  const std::string name = GetParam();
  const test::Ran ran =
      test::run_torsion({"render", test::scene("looks/" + name), "--at", "2", "--size", "320x240",
                         "--heat", "none", "--no-overlay", "--out", folder / "look.png"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.err, "");  // no warning of a texture either
  const Result<Image> image = read_png(folder / "look.png");
  ASSERT_TRUE(image.ok()) << image.error().text;
  const std::filesystem::path golden =
      std::filesystem::path(test::source_folder()) / "tests/images" / ("look_" + name + ".png");
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing sets it
  if (std::getenv("TORSION_UPDATE_IMAGES") != nullptr) {
    ASSERT_TRUE(write_png(image.value(), golden).ok());
  }
  EXPECT_TRUE(matches_golden(image.value(), golden,
                             std::filesystem::path(test::build_folder()) / "images"));
}

INSTANTIATE_TEST_SUITE_P(Scenes, LooksTest,
                         testing::Values("finger_on_lid", "screwdriver_on_gel",
                                         "stethoscope_on_belly", "knob_on_mat", "drill_on_foam"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace torsion::engine
