// Friction so high that pressures and tractions, solved in turn, would answer each other with
// growing errors: from mu (1 - 2 nu) / (2 (1 - nu)) = 1 on.

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::PressedBall;

/// A ball's forces while it is pressed, dragged, lifted by a third and turned, and dragged back.
/// @param finer  steps for each of those whose force is returned
std::vector<glm::dvec3> drag(double friction, int finer) {
  constexpr int kSteps = 150;
  BallScene scene{.poisson = 0.0};
  scene.static_friction = scene.dynamic_friction = friction;
  PressedBall ball(scene);
  std::vector<glm::dvec3> forces;
  const auto go = [&](double depth, const glm::dvec2& way, double turn) {
    const double from = ball.depth();
    for (int step = 1; step <= kSteps; ++step) {
      ball.go(from + (depth - from) * step / kSteps, way / double{kSteps}, turn / kSteps, finer);
      forces.push_back(ball.hand.wrench().force);
    }
  };
  const double way = 1.5 * friction * kBallDepth;
  const double turn = 0.02 * friction;
  ball.press(kBallDepth, 300);
  go(kBallDepth, {way, 0.0}, 0.0);
  go(0.6 * kBallDepth, {0.0, 0.5 * way}, turn);
  go(kBallDepth, {-way, 0.2 * way}, -turn);
  return forces;
}

// A step leaves 0.3 of an error (rounds.cpp), so what is left after many is at most 0.3 / 0.7 of
// what a step changes. At friction of 9 it is twice that: there friction displaces the surface by
// more than the contact's width, and what has slipped depends on the steps.
TEST(MuchFrictionTest, StepsLeaveWhatTheirRoundsDo) {
  constexpr double kLeft = 0.3 / (1.0 - 0.3);
  for (const double friction : {2.0, 4.0}) {
    const std::vector<glm::dvec3> coarse = drag(friction, 1);
    const std::vector<glm::dvec3> fine = drag(friction, 8);
    double apart = 0.0;
    double step = 0.0;
    for (std::size_t k = 1; k < fine.size(); ++k) {
      apart = std::max(apart, glm::distance(coarse[k], fine[k]));
      step = std::max(step, glm::distance(fine[k], fine[k - 1]));
    }
    EXPECT_LE(apart, kLeft * step) << friction;
  }
}

}  // namespace
}  // namespace torsion::engine
