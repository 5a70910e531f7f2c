#include "systems/hold/passivity.hpp"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kPeriod;

PassivityLimits strong() {
  return {1e4, 1e4, 0.01, 0};
}

/// Energy that the hand got from a wall of stiffness K, pressed at a constant speed to a depth and
/// left again.
/// @param turns  the wall is one of turning
double gained_from_wall(double stiffness, double speed, double depth, bool controlled, bool turns) {
  PassivityState state;
  Wrench held;
  double gained = 0.0;
  const int steps = static_cast<int>(std::lround(depth / (speed * kPeriod)));
  double at = 0.0;
  for (int i = 0; i <= 2 * steps + 5; ++i) {
    const double way = i == 0 ? 0.0 : i <= steps ? speed * kPeriod : -speed * kPeriod;
    at += way;
    const glm::dvec3 along(0.0, way, 0.0);
    gained += glm::dot(turns ? held.torque : held.force, along);
    Wrench wanted;
    (turns ? wanted.torque : wanted.force).y = -stiffness * std::max(at, 0.0);
    const glm::dvec3 none(0.0);
    held = controlled ? keep_passive(state, strong(), wanted, turns ? none : along,
                                     turns ? along : none, kPeriod)
                      : wanted;
  }
  return gained;
}

TEST(PassivityTest, ASampledWallMakesKTimesTTimesSpeedTimesDepth) {
  EXPECT_NEAR(gained_from_wall(1000.0, 0.1, 0.01, false, false), 1e-3, 1e-12);
  EXPECT_NEAR(gained_from_wall(500.0, 0.2, 0.02, false, false), 500.0 * kPeriod * 0.2 * 0.02,
              1e-12);
}

TEST(PassivityTest, ControllerTakesBackWhatTheWallMakes) {
  for (const bool turns : {false, true}) {
    EXPECT_LE(gained_from_wall(1000.0, 0.1, 0.01, true, turns), 1e-12);
  }
}

TEST(PassivityTest, LeavesAPassiveWrenchAlone) {
  PassivityState state;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 shift(1e-4 * std::sin(0.01 * i), 0.0, 0.0);
    Wrench damper;
    damper.force = -3.0 * shift / kPeriod;  // of the last interval; slow, so also of the next
    const Wrench sent = keep_passive(state, strong(), damper, shift, glm::dvec3(0.0), kPeriod);
    EXPECT_EQ(sent.force, damper.force);
  }
  EXPECT_EQ(state.translation.dissipated, 0.0);
}

TEST(PassivityTest, HandNeverGainsMoreThanOneIntervalOwes) {
  // Whatever is wanted and however the handle goes, the books may be short only by what the last
  // held force did.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  PassivityState state;
  double gained = 0.0;
  glm::dvec3 velocity(0.0);
  Wrench held;
  double most_in_one = 0.0;
  for (int i = 0; i < 100000; ++i) {
    velocity = 0.99 * velocity + 0.005 * glm::dvec3(normal(random), normal(random), normal(random));
    const glm::dvec3 shift = velocity * kPeriod;
    const double work = glm::dot(held.force, shift);
    gained += work;
    most_in_one = std::max(most_in_one, work);
    Wrench wanted;
    wanted.force = glm::dvec3(normal(random), normal(random), normal(random));
    held = keep_passive(state, strong(), wanted, shift, glm::dvec3(0.0), kPeriod);
    EXPECT_LE(gained, 3.0 * most_in_one + 1e-12) << i;
  }
}

TEST(PassivityTest, DoesNotLetALongPastPayForABurst) {
  PassivityState state;
  Wrench damper;
  for (int i = 0; i < 5000; ++i) {
    damper.force.x = -10.0;
    keep_passive(state, strong(), damper, {1e-3, 0.0, 0.0}, glm::dvec3(0.0), kPeriod);
  }
  EXPECT_EQ(state.translation.stored, strong().largest_stored);
}

TEST(PassivityTest, AddsNoMoreDampingThanItMay) {
  PassivityLimits limits = strong();
  limits.largest_damping = 2.0;
  PassivityState state;
  Wrench pushing;
  pushing.force.x = 100.0;
  const glm::dvec3 shift(1e-3, 0.0, 0.0);
  keep_passive(state, limits, pushing, shift, glm::dvec3(0.0), kPeriod);
  const Wrench sent = keep_passive(state, limits, pushing, shift, glm::dvec3(0.0), kPeriod);
  EXPECT_NEAR(sent.force.x, 100.0 - 2.0 * 1.0, 1e-12);
}

TEST(PassivityTest, DividesByNothingWhenStill) {
  PassivityState state;
  state.translation.stored = -1.0;
  Wrench wanted;
  wanted.force.x = 1.0;
  const Wrench sent =
      keep_passive(state, strong(), wanted, glm::dvec3(0.0), glm::dvec3(0.0), kPeriod);
  EXPECT_EQ(sent.force, wanted.force);
}

}  // namespace
}  // namespace torsion::engine
