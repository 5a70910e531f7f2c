// Contact model patch under a ball that rolls: cells come into contact in front and leave it
// behind, the grid goes with the contact over the body's material, and what friction has built up
// stays on the material that it was built up on.

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/studies.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::kBallFriction;
using test::kBallRadius;
using test::kBallShearModulus;
using test::PressedBall;

// Kalker's creep coefficients of a round contact with nu = 0.5: friction over G a^2 and the
// creepage, with G / 2 of two like bodies; a rigid ball has 2 G of the body in its place. Source:
// Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, table E3. Solved densely
// (Cerruti's rectangles, no slip) on 208 to 1800 cells they come out within 5 to 2 %, by the
// staircase of the rear rim, where the traction has no limit.
constexpr double kKalkerAlong = 5.20;
constexpr double kKalkerAcross = 3.98;

/// A ball that is pressed and goes along x.
class RollingBall {
 public:
  explicit RollingBall(const BallScene& scene) : ball(scene) {
    ball.press(kBallDepth, 200);
    ball.press(kBallDepth, 20);
    radius_ = ball.hertz().radius;
  }
  /// A tenth of the contact's radius on, sideways by a share of that. `creepage` is how much faster
  /// the centre goes than the rim turns, as a share.
  void roll_on(double creepage, double sideways = 0.0, double sign = 1.0) {
    const double way = 0.1 * sign * radius_;
    ball.hand.move({way, 0.0, sideways * way}, {0.0, 0.0, 1.0},
                   -way / (kBallRadius * (1.0 + creepage)), 10);
  }
  /// Friction of steady rolling: the mean over the last two radii of eight.
  glm::dvec2 steady(double creepage, double sideways) {
    glm::dvec2 sum(0.0);
    for (int k = 0; k < 80; ++k) {
      roll_on(creepage, sideways);
      sum += k >= 60 ? ball.friction() / 20.0 : glm::dvec2(0.0);
    }
    return sum;
  }
  /// What Kalker's coefficients are multiplied with, N.
  [[nodiscard]] double unit() const { return 2.0 * kBallShearModulus * radius_ * radius_; }

  PressedBall ball;

 private:
  double radius_ = 0.0;
};

struct RollingCase {
  std::uint32_t side;
  std::uint32_t iterations;
  // Bounds as of a ball that unloads in place (patch_mdr_ball_test.cpp).
  double force;     // settled, relative
  double friction;  // over the largest force and couple
};

class PatchRollingTest : public testing::TestWithParam<RollingCase> {
 protected:
  [[nodiscard]] static BallScene scene(double friction = kBallFriction) {
    return {.side = GetParam().side,
            .iterations = GetParam().iterations,
            .static_friction = friction,
            .dynamic_friction = friction};
  }
};

TEST_P(PatchRollingTest, PureRollingKeepsTheForceAndHardlyPulls) {
  RollingBall rolling(scene());
  const double force = rolling.ball.hertz().force;
  // A ball's point at r from the contact's middle goes back by r^2 / (2 R^2) less than the centre
  // goes on: creepage of that much at most, so a friction between none and Kalker's for the rim's.
  const double square = std::pow(rolling.ball.hertz().radius / kBallRadius, 2);
  const double most = kKalkerAlong * rolling.unit() * 0.5 * square;
  EXPECT_LT(most, 0.13 * kBallFriction * force);
  for (int k = 0; k < 60; ++k) {
    rolling.roll_on(0.0);
    EXPECT_NEAR(rolling.ball.normal_force() / force, 1.0, GetParam().force) << k;
    EXPECT_LE(-rolling.ball.friction().x, most) << k;
    EXPECT_GE(-rolling.ball.friction().x, -0.003 * kBallFriction * force) << k;
    EXPECT_NEAR(rolling.ball.friction().y, 0.0, 0.003 * kBallFriction * force) << k;
  }
}

TEST_P(PatchRollingTest, ToAndFroOverManyCellsComesBackToTheForce) {
  RollingBall rolling(scene());
  const double force = rolling.ball.normal_force();
  const double depth = rolling.ball.depth();
  for (int turn = 0; turn < 3; ++turn) {
    for (const double sign : {1.0, -1.0}) {
      for (int k = 0; k < 30; ++k) {
        rolling.roll_on(0.0, 0.0, sign);
      }
    }
    EXPECT_EQ(rolling.ball.depth(), depth);
    EXPECT_NEAR(rolling.ball.hand.poses[0].position.x, 0.0, 1e-12);
    // The grid lies over other places of the contact: each is off by its bound at most.
    EXPECT_NEAR(rolling.ball.normal_force() / force, 1.0, GetParam().force) << turn;
  }
}

TEST_P(PatchRollingTest, CreepsAsKalkerSays) {
  // So much friction that nothing slips, as the coefficients have it. The difference of two creeps
  // does not know where exactly rolling is pure.
  constexpr double kCreep = 0.01;
  const BallScene rough = scene(20.0);
  RollingBall faster(rough);
  RollingBall slower(rough);
  RollingBall sideways(rough);
  const double along = faster.steady(kCreep, 0.0).x - slower.steady(-kCreep, 0.0).x;
  const double across = sideways.steady(0.0, kCreep).y;
  EXPECT_NEAR(-along / (2.0 * kCreep * faster.unit()) / kKalkerAlong, 1.0, 0.04);
  EXPECT_NEAR(-across / (kCreep * sideways.unit()) / kKalkerAcross, 1.0, 0.04);
}

/// Slides to half of what makes all slip, then rolls three radii: friction along and across, and
/// the couple about the normal, at every tenth of a radius.
std::vector<glm::dvec3> slide_and_roll(const BallScene& scene) {
  RollingBall rolling(scene);
  const double slide = 0.5 * reference::full_slip_displacement(rolling.ball.mindlin());
  const double turn = 0.5 * reference::saturated_torque(rolling.ball.lubkin()) /
                      reference::torsional_stiffness(rolling.ball.lubkin());
  rolling.ball.go(kBallDepth, {0.6 * slide, 0.8 * slide}, turn, 100);
  std::vector<glm::dvec3> loads;
  for (int k = 0; k < 30; ++k) {
    const PressedBall& ball = rolling.ball;
    loads.emplace_back(ball.friction().x, ball.friction().y, ball.couple());
    rolling.roll_on(0.0);
  }
  return loads;
}

TEST_P(PatchRollingTest, WhatASlideHasBuiltUpIsLeftBehindAsOnAFinerGrid) {
  if (test::is_left_out(GetParam().side == 12)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const std::vector<glm::dvec3> found = slide_and_roll(scene());
  const std::vector<glm::dvec3> fine = slide_and_roll({.side = 36, .iterations = 40});
  PressedBall pressed(BallScene{});
  pressed.press(kBallDepth, 1);
  const double limit = reference::full_slip_force(pressed.mindlin());
  const double largest = reference::saturated_torque(pressed.lubkin());
  // It was there, and three radii on it is gone across.
  EXPECT_GT(std::abs(fine.front().y), 0.4 * limit);
  EXPECT_LT(std::abs(fine.back().y), 0.1 * std::abs(fine.front().y));
  for (std::size_t k = 0; k < fine.size(); ++k) {
    EXPECT_NEAR(found[k].x, fine[k].x, GetParam().friction * limit) << k;
    EXPECT_NEAR(found[k].y, fine[k].y, GetParam().friction * limit) << k;
    EXPECT_NEAR(found[k].z, fine[k].z, GetParam().friction * largest) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, PatchRollingTest,
                         testing::Values(RollingCase{12, 2, 0.008, 0.02},
                                         RollingCase{16, 2, 0.005, 0.015},
                                         RollingCase{24, 8, 0.005, 0.0065}));

}  // namespace
}  // namespace torsion::engine
