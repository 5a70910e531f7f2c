// The hand at the window under Xvfb, played by a script; what it did to the tool is read from the
// recording, run again (window_hand_test.sh).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/image_io.hpp"
#include "tests/app/program.hpp"
#include "tests/app/window_pictures.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using test::read_text;

constexpr double kAnimated = 4.0;  // s: so long the scene's animation moves the tool

struct TraceLine {
  double time = 0.0;   // s
  double x = 0.0;      // m
  double y = 0.0;      // m
  double z = 0.0;      // m
  double angle = 0.0;  // rad, about the vertical
  double force = 0.0;  // N, vertical
};

std::vector<TraceLine> read_trace(const std::string& path) {
  std::istringstream rows(read_text(path));
  std::string row;
  std::getline(rows, row);
  std::vector<TraceLine> lines;
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::string cell;
    std::array<double, 12> values{};
    for (double& value : values) {
      std::getline(cells, cell, ',');
      value = std::stod(cell);
    }
    // time, x, y, z, qx, qy, qz, qw, regions, cells, force x, y
    lines.push_back({values[0], values[1], values[2], values[3],
                     2.0 * std::atan2(values[5], values[7]), values[11]});
  }
  return lines;
}

class WindowHandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::Folder;
    const std::string command = "xvfb-run -a -s '-screen 0 1280x720x24' " + test::source_folder() +
                                "/tests/app/window_hand_test.sh " + test::build_folder() +
                                "/torsion " + test::scene("ball_on_cube_soft") + " " +
                                (*folder_ / ".") + " > " + (*folder_ / "log") + " 2>&1";
    status_ = std::system(command.c_str());  // NOLINT(cert-env33-c,concurrency-mt-unsafe): a script
    if (status_ == 0) {
      trace_ = read_trace(*folder_ / "trace.csv");
    }
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    ASSERT_EQ(status_, 0) << read_text(*folder_ / "log") << read_text(*folder_ / "session.err");
    ASSERT_GT(trace_.size(), 4000U);
  }

  static double changed(const std::string& a, const std::string& b) {
    const Result<Image> before = read_png(*folder_ / (a + ".png"));
    const Result<Image> after = read_png(*folder_ / (b + ".png"));
    EXPECT_TRUE(before.ok() && after.ok());
    return before && after ? test::changed(before.value(), after.value(), 330, 60, 1270, 660) : 0.0;
  }

  static test::Folder* folder_;
  static int status_;
  static std::vector<TraceLine> trace_;
};
test::Folder* WindowHandTest::folder_ = nullptr;
int WindowHandTest::status_ = -1;
std::vector<TraceLine> WindowHandTest::trace_;

TEST_F(WindowHandTest, PressingMovesTheToolAlongTheNormalAlone) {
  ASSERT_GT(trace_.back().time, kAnimated);
  double above = 0.0;   // m: at the animation's end
  double lowest = 1.0;  // m: after it
  double force = 0.0;   // N: likewise
  for (const TraceLine& line : trace_) {
    // The view is oblique; a hundredth of what the mouse moved would be 0.1 mm.
    ASSERT_LT(std::hypot(line.x, line.z), 1e-4) << "at " << line.time << " s";
    if (line.time <= kAnimated) {
      above = line.y;
    } else {
      lowest = std::min(lowest, line.y);
      force = std::max(force, line.force);
    }
  }
  EXPECT_LT(lowest, above - 0.005);
  EXPECT_GT(force, 0.5);
}

TEST_F(WindowHandTest, LetGoOfTheToolGoesBackToTheAnimation) {
  // Which has ended: where it began, above the cube, but turned by 60 degrees.
  const TraceLine& end = trace_.back();
  EXPECT_EQ(end.force, 0.0);
  EXPECT_NEAR(end.y, trace_.front().y, 1e-6);
  EXPECT_NEAR(end.angle, std::numbers::pi / 3.0, 1e-6);
  for (std::size_t i = 1; i < trace_.size(); ++i) {
    ASSERT_LT(std::abs(trace_[i].y - trace_[i - 1].y), 1e-3) << "at " << trace_[i].time << " s";
  }
}

/// When the tool turned last before `end`, s.
double last_turn(const std::vector<TraceLine>& trace, double end) {
  double last = 0.0;
  for (std::size_t i = 1; i < trace.size() && trace[i].time < end; ++i) {
    last = std::abs(trace[i].angle - trace[i - 1].angle) > 1e-5 ? trace[i].time : last;
  }
  return last;
}

TEST_F(WindowHandTest, AMoveByNumbersIsAsLongAsItSaysAndHasNoStaircase) {
  // 30 degrees in 2 s. The tool follows the handle but for the coupling's give: the torque rises
  // over the move, so it turns by less, and by more than half.
  // At the end of all the tool was let go of, and went back within a second.
  const double let_go = last_turn(trace_, 1e9) - 1.0;
  const double end = last_turn(trace_, let_go - 0.05);
  double turned = 0.0;
  double fastest = 0.0;  // rad a step
  for (std::size_t i = 1; i < trace_.size(); ++i) {
    if (trace_[i].time > end - 2.3 && trace_[i].time <= end) {
      const double step = trace_[i].angle - trace_[i - 1].angle;
      turned += step;
      fastest = std::max(fastest, std::abs(step));
    }
  }
  const double asked = 30.0 * std::numbers::pi / 180.0;
  EXPECT_GT(turned, 0.5 * asked);
  EXPECT_LT(turned, 1.001 * asked);
  // The eased motion is fastest at 1.5 times its mean. A picture's part of it at once would be, at
  // 60 a second, 17 times that; pictures may be as slow as two a second here, and what comes of
  // half a second through the two low passes has a peak of 1 / (e tau).
  const double mean = asked / 2000.0;
  const double slow_pictures = asked * 1.5 * 0.25 * 1e-3 / (std::numbers::e * 0.015);
  EXPECT_GT(fastest, mean);
  EXPECT_LT(fastest, std::max(4.0 * mean, slow_pictures));
}

TEST_F(WindowHandTest, TheRingTurnsTheToolTheWayItIsDragged) {
  // The last turn before that of the numbers, which takes 2 s. 60 pixels along the ring's near side
  // of 166 from its middle to its end are at most asin(60 / 166) = 0.37 rad, since that side is
  // nearer than the middle, counter-clockwise seen from above. Part of it is the coupling's.
  const double let_go = last_turn(trace_, 1e9) - 1.0;
  const double moved = last_turn(trace_, let_go - 0.05);
  const double end = last_turn(trace_, moved - 2.3);
  double turned = 0.0;
  for (std::size_t i = 1; i < trace_.size(); ++i) {
    turned += trace_[i].time > end - 0.5 && trace_[i].time <= end
                  ? trace_[i].angle - trace_[i - 1].angle
                  : 0.0;
  }
  EXPECT_GT(turned, 0.2 * 0.37);
  EXPECT_LT(turned, 0.37);
}

TEST_F(WindowHandTest, TheCameraComesBack) {
  EXPECT_GT(changed("moved", "orbited"), 0.2);
  EXPECT_LT(changed("moved", "back"), 0.01);
}

}  // namespace
}  // namespace torsion::engine
