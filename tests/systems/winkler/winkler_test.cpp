#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;
using test::kBallDepth;
using test::kBallFriction;
using test::kBallRadius;
using test::PressedBall;

// A ball on a bed of springs, whose pressure is its stiffness times the overlap: force and couple
// are integrals over a spherical cap. Cells cover the rim to the second order: 24 of them across
// are within 1 %.
constexpr std::uint32_t kSide = 24;
constexpr double kWithin = 0.01;

test::BallScene winkler_scene() {
  return {.model = ContactModel::kWinkler, .side = kSide};
}

/// Pa/m: E over half the side of the cube of 0.1 m.
double bed_of_cube() {
  return 3.0 * test::kBallShearModulus / 0.05;
}

/// Of the cap of depth d, m^3: pi d^2 (R - d / 3).
double cap_volume(double depth) {
  return pi * depth * depth * (kBallRadius - depth / 3.0);
}

TEST(WinklerTest, NormalForceIsTheBedsOnTheOverlapsVolume) {
  PressedBall ball(winkler_scene());
  for (const double share : {0.25, 0.5, 1.0, 2.0}) {
    ball.press(share * kBallDepth, 40);
    ball.press(ball.depth(), 10);
    EXPECT_NEAR(ball.normal_force() / (bed_of_cube() * cap_volume(ball.depth())), 1.0, kWithin)
        << share;
  }
}

TEST(WinklerTest, SpinningCoupleIsThatOfAParabolaOfPressure) {
  PressedBall ball(winkler_scene());
  ball.press(kBallDepth, 40);
  ball.press(kBallDepth, 10);
  const double force = ball.normal_force();
  ball.twist(2.0, 40);
  // Within it the bed's pressure is (1 - r^2 / a^2): 8/15 mu F a, and a^2 = 2 R d but for d / R.
  const double radius = std::sqrt(2.0 * kBallRadius * kBallDepth);
  const double expected = 8.0 / 15.0 * kBallFriction * force * radius;
  EXPECT_NEAR(ball.couple() / -expected, 1.0, kWithin + kBallDepth / kBallRadius);
  // A half-space's, 3 pi / 16 mu F a with a^2 = R d, is 28 % less.
  const double half_space =
      3.0 * pi / 16.0 * kBallFriction * force * std::sqrt(kBallRadius * kBallDepth);
  EXPECT_GT(ball.couple() / -half_space, 1.2);
}

TEST(WinklerTest, SlidingFrictionIsCoulombs) {
  PressedBall ball(winkler_scene());
  ball.press(kBallDepth, 40);
  ball.slide({5e-4, 0.0}, 50);  // 10 mm/s
  EXPECT_NEAR(glm::length(ball.friction()) / ball.normal_force(), kBallFriction, 1e-3);
  EXPECT_LT(ball.friction().x, 0.0);
}

// It is what engines have: friction at rest is none, so that a tool creeps where it should stick.
TEST(WinklerTest, HoldsNothingAtRest) {
  PressedBall ball(winkler_scene());
  ball.press(kBallDepth, 40);
  ball.slide({5e-6, 0.0}, 50);  // a tenth of the velocity at which all of the friction is there
  EXPECT_LT(glm::length(ball.friction()), 0.05 * kBallFriction * ball.normal_force());
  ball.slide({0.0, 0.0}, 5);
  EXPECT_LT(glm::length(ball.friction()), 1e-9 * ball.normal_force());
}

}  // namespace
}  // namespace torsion::engine
