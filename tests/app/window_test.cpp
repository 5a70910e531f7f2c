// The window under Xvfb with a real swapchain; mouse and keys come from xdotool (window_test.sh).

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/image_io.hpp"
#include "tests/app/program.hpp"
#include "tests/app/window_pictures.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using test::changed;
using test::has_red_banner;
using test::read_text;

class WindowTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::Folder;
    const std::string command = "xvfb-run -a -s '-screen 0 1280x720x24' " + test::source_folder() +
                                "/tests/app/window_test.sh " + test::build_folder() + "/torsion " +
                                test::scene("ball_on_cube_soft") + " " + test::build_folder() +
                                "/has_red_banner " + (*folder_ / ".") + " > " + (*folder_ / "log") +
                                " 2>&1";
    status_ = std::system(command.c_str());  // NOLINT(cert-env33-c,concurrency-mt-unsafe): a script
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    ASSERT_EQ(status_, 0) << read_text(*folder_ / "log") << read_text(*folder_ / "session.err");
  }
  static Image shot(const std::string& name) {
    const Result<Image> image = read_png(*folder_ / (name + ".png"));
    EXPECT_TRUE(image.ok());
    return image.ok() ? image.value() : Image{};
  }

  static test::Folder* folder_;
  static int status_;
};
test::Folder* WindowTest::folder_ = nullptr;
int WindowTest::status_ = -1;

TEST_F(WindowTest, ValidationLayersAreSilent) {
  // The layers write to stdout; the session's JSON is all that may be there.
  const std::string out = read_text(*folder_ / "session.json");
  EXPECT_EQ(out.find("VUID"), std::string::npos) << out;
  EXPECT_EQ(out.find("SYNC-HAZARD"), std::string::npos) << out;
  EXPECT_EQ(out.find("Validation"), std::string::npos) << out;
}

TEST_F(WindowTest, TheMousePressesTheToolAndItIsFelt) {
  const auto session = nlohmann::json::parse(read_text(*folder_ / "session.json"));
  EXPECT_GT(session["pictures"].get<int>(), 10);
  // Reloaded at the end, so what was felt is in the pictures: the plots in the panel.
  EXPECT_GT(changed(shot("before"), shot("pressed"), 70, 268, 310, 398), 0.005);
  // And the ball and the arrows over the body.
  EXPECT_GT(changed(shot("before"), shot("pressed"), 640, 60, 960, 400), 0.02);
}

TEST_F(WindowTest, DraggingBesideTheToolTurnsTheView) {
  EXPECT_GT(changed(shot("pressed"), shot("turned"), 330, 400, 1090, 640), 0.2);
}

TEST_F(WindowTest, AVideoHasTheTimeThatPassedAndTheWindowsSize) {
  const std::string facts = *folder_ / "video.json";
  const std::string command =
      "ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames "
      "-of json " +
      (*folder_ / "video.mp4") + " > " + facts;
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  const auto stream = nlohmann::json::parse(read_text(facts))["streams"][0];
  EXPECT_EQ(stream["width"].get<int>(), 1280);
  EXPECT_EQ(stream["height"].get<int>(), 720);
  // 25 pictures a second: of what was surely in it, and of what can have been.
  const auto times = nlohmann::json::parse(read_text(*folder_ / "video_times.json"));
  const auto seconds = [&](std::size_t from, std::size_t to) {
    return times[to].get<double>() - times[from].get<double>();
  };
  const int pictures = std::stoi(stream["nb_read_frames"].get<std::string>());
  EXPECT_GE(pictures, 25.0 * seconds(0, 1) - 1.0);
  EXPECT_LE(pictures, 25.0 * seconds(2, 3) + 1.0);
}

TEST_F(WindowTest, SurvivesBeingTakenAwayAndAnotherSize) {
  const Image image = shot("resized");
  EXPECT_EQ(image.width, 900U);
  EXPECT_EQ(image.height, 600U);
}

TEST_F(WindowTest, ABadSceneFileIsSaidAndTheOldSceneStaysUntilItIsGoodAgain) {
  EXPECT_FALSE(has_red_banner(shot("resized")));
  EXPECT_TRUE(has_red_banner(shot("bad")));
  EXPECT_FALSE(has_red_banner(shot("good")));
  // The body in the middle is still drawn.
  EXPECT_LT(changed(shot("resized"), shot("bad"), 350, 300, 550, 400), 0.9);
}

TEST_F(WindowTest, ItsRecordingPlaysBack) {
  const test::Ran ran = test::run_torsion({"simulate", *folder_ / "ball_on_cube_soft.gltf",
                                           "--replay", *folder_ / "session.rec", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_GT(nlohmann::json::parse(ran.out)["steps"].get<int>(), 100);
}

}  // namespace
}  // namespace torsion::engine
