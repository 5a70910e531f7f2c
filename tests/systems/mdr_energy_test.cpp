#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/pressed_ball.hpp"

namespace torsion {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallDepth;
using test::kBallRadius;
using test::make_ball_scene;
using test::options_of;
using test::PressedBall;

/// Where the ball is, over the place where it was pressed.
struct Place {
  glm::dvec3 shift{0.0};  // m
  double turn = 0.0;      // rad, about the world's y
};

constexpr std::size_t kWay = 3;  // steps away; as many lead back in another order

/// Goes away in random steps and back in the same steps in another order. A step goes down or up,
/// or aside and round: work by the mean of two forces counts what a rim that is gone had held over
/// half of the way that it never went.
std::array<Place, 2 * kWay> random_path(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  // A part in 10^4 of the depth: the mean of two forces is off by (h / depth)^2 / 16 = 6e-10 of a
  // power law of 3 / 2. Slides and turns from a part in 10^5 to a tenth of what slips all.
  const double depth = 1e-4 * kBallDepth;
  const double size = std::pow(10.0, -3.0 + 2.0 * uniform(random));
  std::array<Place, kWay> steps;
  for (Place& step : steps) {
    const bool down = uniform(random) < 0.0;
    step =
        down
            ? Place{{0.0, depth * uniform(random), 0.0}, 0.0}
            : Place{{size * kBallDepth * uniform(random), 0.0, size * kBallDepth * uniform(random)},
                    0.1 * size * uniform(random)};
  }
  std::array<Place, 2 * kWay> path;
  Place at;
  for (std::size_t k = 0; k < kWay; ++k) {
    at = {at.shift + steps[k].shift, at.turn + steps[k].turn};
    path[k] = at;
  }
  std::shuffle(steps.begin(), steps.end(), random);
  for (std::size_t k = 0; k + 1 < kWay; ++k) {
    at = {at.shift - steps[k].shift, at.turn - steps[k].turn};
    path[kWay + k] = at;
  }
  path.back() = {};
  return path;
}

class MdrEnergyTest : public testing::TestWithParam<double> {};

TEST_P(MdrEnergyTest, FiftyThousandClosedPathsOfSmallStepsCostWork) {
  // The goal: never below -1e-9 of the path's throughput, the sum of what went to and fro.
  // The force of a depth is the gradient of a potential, for depth and normal come from the shapes;
  // every layer of springs takes what it stores or more (mdr_properties_test.cpp). From springs at
  // rest, for what was stored before may well be given back.
  const BallScene scene{.model = ContactModel::kMdr, .poisson = GetParam()};
  PrepareOptions options = options_of(scene);
  options.rate = 10.0;  // Hz: what a new region exerts fades in within one step
  Hand hand(make_ball_scene(scene), options);
  const glm::dvec3 home(0.0, 0.1 + kBallRadius - kBallDepth, 0.0);
  const Pose at_home{home, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  const Pose above{home + glm::dvec3(0.0, 2.0 * kBallDepth, 0.0), at_home.rotation};
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < 50000; ++path) {
    hand.step_to({above});
    hand.step_to({at_home});
    hand.step_to({at_home});
    double sum = 0.0;
    double throughput = 0.0;
    Place before;
    for (const Place& place : random_path(random)) {
      const glm::dvec3 from = hand.poses[0].position;
      const Wrench wrench = hand.wrench();
      hand.step_to({{home + place.shift, glm::angleAxis(place.turn, glm::dvec3(0, 1, 0))}});
      const Wrench& after = hand.wrench();
      // What was gone, not what was asked for: a step has few digits of the place.
      const glm::dvec3 gone = -0.5 * (wrench.force + after.force) * (hand.poses[0].position - from);
      const double turned = -0.5 * (wrench.torque.y + after.torque.y) * (place.turn - before.turn);
      sum += gone.x + gone.y + gone.z + turned;
      throughput += std::abs(gone.x) + std::abs(gone.y) + std::abs(gone.z) + std::abs(turned);
      before = place;
    }
    least = std::min(least, sum / throughput);
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
      const double force = ball.hand.world().regions.at<RegionNormal>(0).force;
      lowest = std::min(lowest, force);
      highest = std::max(highest, force);
    }
    EXPECT_LE(highest / lowest - 1.0, 1e-11) << depth;
  }
}

}  // namespace
}  // namespace torsion
