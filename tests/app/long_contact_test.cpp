// A screwdriver's blade, 8 mm by 1.2 mm, that turns on gel by 90 degrees: its grid is laid anew
// along it again and again, and the torque must not tell when.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "app/session.hpp"
#include "tests/support/paths.hpp"

namespace torsion::test {
namespace {

/// The torque about the blade's axis in each step, N m.
/// @param side  cells along a side of the grids; 0: as `auto` has it
std::vector<double> torques_with(std::uint32_t side) {
  PrepareOptions options;
  options.settings.grid_side = side;
  Result<Session> opened =
      open_session(source_folder() + "/tests/cases/driver2.glb", options, true);
  EXPECT_TRUE(opened) << opened.error().text;
  Session& session = opened.value();
  std::vector<double> torques;
  const std::uint64_t steps = steps_in(session, session.scene.duration);
  for (std::uint64_t i = 0; i < steps; ++i) {
    step_scripted(session);
    torques.push_back(session.simulation.world.tools.at<ToolWrench>(0).total.torque.y);
  }
  return torques;
}

double largest_size(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) {
    most = std::max(most, std::abs(value));
  }
  return most;
}

double largest_step(const std::vector<double>& values) {
  double most = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    most = std::max(most, std::abs(values[i] - values[i - 1]));
  }
  return most;
}

TEST(LongContactTest, ATurningBladeKeepsItsTorqueWhereItsGridIsLaidAnew) {
  // Every grid is off by what its rims miss, up to a cell of 10, whose share of the torque is its
  // square's: a tenth. What is left of that fades in by a twentieth a step at most.
  const std::vector<double> fine = torques_with(36);
  const double most = largest_size(fine);
  const std::vector<double> found = torques_with(0);
  ASSERT_EQ(found.size(), fine.size());
  double sum = 0.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    worst = std::max(worst, std::abs(found[i] - fine[i]));
    sum += std::abs(found[i] - fine[i]);
  }
  EXPECT_LE(worst, 0.1 * most);
  EXPECT_LE(sum / static_cast<double>(fine.size()), 0.03 * most);
  EXPECT_LE(largest_step(found), 0.05 * most);
  EXPECT_LE(largest_step(fine), 0.05 * most);
}

}  // namespace
}  // namespace torsion::test
