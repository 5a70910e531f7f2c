#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::PressedBall;

/// Work of the hand over a path, by the mean of the wrenches before and after each step, and how
/// much went to and fro.
struct Work {
  double sum = 0.0;
  double throughput = 0.0;

  /// One step to a depth, by `way` and `turn`.
  void step(PressedBall& ball, double depth, const glm::dvec2& way, double turn) {
    const Wrench before = ball.hand.wrench();
    const glm::dvec3 shift(way.x, ball.depth() - depth, way.y);
    ball.go(depth, way, turn, 1);
    const Wrench& after = ball.hand.wrench();
    // The hand pulls against the body; the torque is about the ball's centre, which it holds.
    const double normal = -0.5 * (before.force.y + after.force.y) * shift.y;
    const double tangential = -0.5 * (before.force.x + after.force.x) * shift.x -
                              0.5 * (before.force.z + after.force.z) * shift.z;
    const double turned = -0.5 * (before.torque.y + after.torque.y) * turn;
    sum += normal + tangential + turned;
    throughput += std::abs(normal) + std::abs(tangential) + std::abs(turned);
  }
};

struct EnergyCase {
  const char* name;
  BallScene scene;
  double deep;  // bound through depths that change by up to 0.3, of the work to and fro
};

void PrintTo(const EnergyCase& energy, std::ostream* out) {
  *out << energy.name;
}

// Neither gains anything (mdr_properties_test.cpp, patch_energy_test.cpp). Through other depths the
// mean of the forces before and after is not the mean over the step: of a power law of 3 / 2 by
// (h / depth)^2 / 16, with h a 25th of the change: 4e-8 of 0.02 depths, 9e-6 of 0.3. Through depths
// so different patch lays its grid anew: the force of a depth is the same again only within the
// staircase of its rim.
constexpr double kStill = 1e-9;
constexpr double kSlightly = 4e-8;
const EnergyCase kEnergyCases[] = {
    {"mdr", {.model = ContactModel::kMdr}, 1e-5},
    {"patch12", {.side = 12}, 1e-3},
    {"patch16", {.side = 16}, 1e-3},
    {"patch12of20Sweeps", {.side = 12, .iterations = 20}, 1e-3},
    {"compressible", {.poisson = 0.3, .side = 12}, 1e-3},
};

class EnergyTest : public testing::TestWithParam<EnergyCase> {};

/// Least work over throughput on random closed polygons of ten sides in small steps.
/// @param breathing  largest relative change of the depth
/// @param size       of a side, in about the slide and turn at which half the contact slips
double least_work(PressedBall& ball, double breathing, double size) {
  double least = 1.0;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int path = 0; path < 5; ++path) {
    ball.press(-1e-5, 1);  // lifts off: springs at rest
    ball.press(kBallDepth, 100);
    ball.press(kBallDepth, 20);
    Work work;
    glm::dvec2 at(0.0);
    double turned = 0.0;
    for (int side = 0; side < 10; ++side) {
      const bool home = side == 9;
      const glm::dvec2 way =
          home ? -at : 1e-4 * size * glm::dvec2(uniform(random), uniform(random));
      const double turn = home ? -turned : 0.03 * size * uniform(random);
      const double depth = home ? kBallDepth : kBallDepth * (1.0 + breathing * uniform(random));
      const double from = ball.depth();
      constexpr int kSteps = 25;
      for (int step = 1; step <= kSteps; ++step) {
        work.step(ball, std::lerp(from, depth, static_cast<double>(step) / kSteps),
                  way / static_cast<double>(kSteps), turn / kSteps);
      }
      at += way;
      turned += turn;
    }
    least = std::min(least, work.sum / work.throughput);
  }
  return least;
}

TEST_P(EnergyTest, ClosedPathsAtConstantDepthCostWork) {
  PressedBall ball(GetParam().scene);
  for (const double size : {0.01, 0.1, 1.0, 10.0}) {
    EXPECT_GE(least_work(ball, 0.0, size), -kStill) << size;
  }
}

TEST_P(EnergyTest, ClosedPathsThroughOtherDepthsCostWork) {
  PressedBall ball(GetParam().scene);
  for (const double breathing : {0.02, 0.3}) {
    for (const double size : {0.01, 0.1, 1.0, 10.0}) {
      EXPECT_GE(least_work(ball, breathing, size), -(breathing < 0.1 ? kSlightly : GetParam().deep))
          << breathing << " " << size;
    }
  }
}

TEST_P(EnergyTest, WhatSlipsCostsAsMuchAsItsForceTimesItsWay) {
  // Ten radii there and back: mu F times the way, but for the elastic ends, which give back what
  // they took; each end costs (3/5) of the displacement of full slip times mu F at most.
  PressedBall ball(GetParam().scene);
  ball.press(kBallDepth, 100);
  Work work;
  const double way = 10.0 * ball.hertz().radius;
  constexpr int kSteps = 1000;
  for (int step = 0; step < kSteps; ++step) {
    work.step(ball, kBallDepth, {way / kSteps * (step < kSteps / 2 ? 2.0 : -2.0), 0.0}, 0.0);
  }
  const double limit = reference::full_slip_force(ball.mindlin());
  const double ends = 3.0 * limit * reference::full_slip_displacement(ball.mindlin());
  // 2 %: normal force of compressible bodies and of cells that wander.
  EXPECT_NEAR(work.sum, 2.0 * limit * way, ends + 0.02 * 2.0 * limit * way);
}

INSTANTIATE_TEST_SUITE_P(Models, EnergyTest, testing::ValuesIn(kEnergyCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace torsion::engine
