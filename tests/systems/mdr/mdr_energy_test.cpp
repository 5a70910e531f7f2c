#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/studies.hpp"
#include "tests/systems/patch/worked_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::kBallRadius;
using test::Place;
using test::PressedBall;
using test::random_path;
using test::WorkedBall;

class MdrEnergyTest : public testing::TestWithParam<double> {};

TEST_P(MdrEnergyTest, ClosedPathsOfSmallStepsCostWork) {
  // The goal: never below -1e-9 of the path's throughput, the sum of what went to and fro.
  // The force of a depth is the gradient of a potential, for depth and normal come from the shapes;
  // every layer of springs takes what it stores or more (mdr_properties_test.cpp). From springs at
  // rest, for what was stored before may well be given back.
  WorkedBall ball({.model = ContactModel::kMdr, .poisson = GetParam()});
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < test::trials_of(50000); ++path) {
    ball.lift_off();
    ball.go(Place{});
    ball.stay(1);
    ball.forget();
    // Slides and turns from a part in 10^5 to a tenth of what slips all.
    ball.go(random_path(random, 1e-5, 1e-1));
    least = std::min(least, ball.work / ball.throughput);
  }
  EXPECT_GE(least, -1e-9);
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, MdrEnergyTest, testing::Values(0.5, 0.3));

TEST(MdrNormalForceTest, IsAFunctionOfTheDepthAlone) {
  // Wherever the ball went in between and however it is turned: to the last digits that the depth
  // has, 1e-17 m of 4e-4 m.
  PressedBall ball(BallScene{.model = ContactModel::kMdr});
  std::mt19937 random(31);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const glm::dvec3 home(0.0, 0.1 + kBallRadius, 0.0);
  for (const double depth : {0.3 * kBallDepth, kBallDepth, 2.0 * kBallDepth}) {
    double lowest = 1e300;
    double highest = -1e300;
    for (int step = 0; step < 400; ++step) {
      const glm::dvec3 aside(0.01 * uniform(random), -depth, 0.01 * uniform(random));
      const glm::dvec3 axis =
          glm::normalize(glm::dvec3(uniform(random), 1.5 + uniform(random), uniform(random)));
      ball.hand.step_to({{home + aside, glm::angleAxis(3.0 * uniform(random), axis)}});
      if (step < 50) {
        continue;  // a region forms, and fades in
      }
      const double force = ball.hand.world().state.regions.at<RegionNormal>(0).force;
      lowest = std::min(lowest, force);
      highest = std::max(highest, force);
    }
    EXPECT_LE(highest / lowest - 1.0, 1e-11) << depth;
  }
}

}  // namespace
}  // namespace torsion::engine
