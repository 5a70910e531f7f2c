// Contact model patch under a ball that rolls with creepage and spin, against the steady state that
// boundary elements find directly: tests/reference/boundary_elements/steady_rolling.cpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
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

constexpr double kBallForce = 10.0;  // N, at kBallDepth

struct SteadyRolling {
  double friction = 0.0;
  double along = 0.0;  // creepages
  double across = 0.0;
  double spin = 0.0;     // 1/m
  glm::dvec3 load{0.0};  // N, N, N m: on the body, along, across and about the normal
};

std::vector<SteadyRolling> read_cases() {
  std::ifstream file(test::source_folder() +
                     "/tests/reference/boundary_elements/steady_rolling.csv");
  std::vector<SteadyRolling> cases;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream stream(line);
    char comma = ',';
    SteadyRolling row;
    stream >> row.friction >> comma >> row.along >> comma >> row.across >> comma >> row.spin >>
        comma >> row.load.x >> comma >> row.load.y >> comma >> row.load.z;
    cases.push_back(row);
  }
  return cases;
}

/// What a ball does to the body that has rolled eight contact radii so, the mean of the last two.
glm::dvec3 load_of_rolling(const BallScene& scene, const SteadyRolling& rolling, double sign) {
  PressedBall ball(scene);
  ball.press(kBallDepth, 200);
  ball.press(kBallDepth, 20);
  const double way = 0.1 * ball.hertz().radius;
  // x, across = -z and the normal y make a right-handed frame.
  const glm::dvec3 turn(0.0, sign * rolling.spin * way,
                        -way * (1.0 - sign * rolling.along) / kBallRadius);
  glm::dvec3 sum(0.0);
  for (int k = 0; k < 80; ++k) {
    ball.hand.move({way, 0.0, -sign * rolling.across * way}, glm::normalize(turn),
                   glm::length(turn), 10);
    if (k >= 60) {
      sum += glm::dvec3(-ball.friction().x, ball.friction().y, -ball.couple()) / 20.0;
    }
  }
  return sum;
}

// The reference's own check. Nothing slips: Kalker's coefficients of a round contact with nu = 0.5,
// Three-Dimensional Elastic Bodies in Rolling Contact, 1990, table E3, times 2 G a^2 and the
// creepage; the rim's staircase costs 2 % (the traction has no limit at the rear). With slip: what
// CONTACT, Vollebregt's program, finds with 400 to 1600 squares, where it has the error of such
// grids: up to 1 % (the column `grid`).
TEST(SteadyRollingReferenceTest, IsNearKalkersCoefficientsAndContact) {
  const std::vector<SteadyRolling> cases = read_cases();
  ASSERT_EQ(cases.size(), 11U);
  const double radius = std::cbrt(0.75 * kBallForce * kBallRadius / (4.0 * kBallShearModulus));
  const double unit = 2.0 * kBallShearModulus * radius * radius;
  EXPECT_NEAR(cases[0].load.x / (unit * cases[0].along) / 5.20, 1.0, 0.02);
  EXPECT_NEAR(cases[1].load.y / (unit * cases[1].across) / 3.98, 1.0, 0.02);
  const auto find = [&](double along, double spin) {
    return std::ranges::find_if(cases,
                                [&](const SteadyRolling& rolling) {
                                  return rolling.friction < 1.0 && rolling.along == along &&
                                         rolling.across == 0.0 && rolling.spin == spin;
                                })
        ->load;
  };
  const double force = kBallFriction * kBallForce;
  const double couple = 3.0 * std::numbers::pi / 16.0 * force * radius;
  EXPECT_NEAR(find(0.02, 0.0).x, 3.66, 0.01 * force);
  for (const auto& [spin, across, about] :
       {std::array{2.0, 0.619, 1.90e-3}, {8.0, 2.355, 6.19e-3}, {20.0, 4.634, 11.78e-3}}) {
    EXPECT_NEAR(find(0.0, spin).y, across, 0.01 * force) << spin;
    EXPECT_NEAR(find(0.0, spin).z, about, 0.01 * couple) << spin;
  }
}

class PatchSteadyRollingTest : public testing::TestWithParam<std::uint32_t> {};

// With the iterations that the settings have. Both ways round: a ball's points off the middle go
// slower than its centre, as under a creepage of their own that does not change sign. Bound: as of
// a contact that slides while it turns (docs/models.md); 12 cells a side, which may be a tenth
// larger or smaller by how the ball came down, are worth 0.2 % more.
TEST_P(PatchSteadyRollingTest, IsNearBoundaryElements) {
  if (test::is_left_out(GetParam() == 12)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const BallScene scene{.side = GetParam()};
  const double bound = GetParam() == 12 ? 0.011 : 0.009;
  for (const SteadyRolling& rolling : read_cases()) {
    if (rolling.friction != kBallFriction) {
      continue;
    }
    const glm::dvec3 load =
        0.5 * (load_of_rolling(scene, rolling, 1.0) - load_of_rolling(scene, rolling, -1.0));
    const double force = kBallFriction * kBallForce;
    const double radius = std::cbrt(0.75 * kBallForce * kBallRadius / (4.0 * kBallShearModulus));
    const double couple = 3.0 * std::numbers::pi / 16.0 * force * radius;
    const std::string which = std::to_string(rolling.along) + " along, " +
                              std::to_string(rolling.across) + " across, spin " +
                              std::to_string(rolling.spin);
    EXPECT_NEAR(load.x, rolling.load.x, bound * force) << which;
    EXPECT_NEAR(load.y, rolling.load.y, bound * force) << which;
    EXPECT_NEAR(load.z, rolling.load.z, bound * couple) << which;
  }
}

INSTANTIATE_TEST_SUITE_P(Sides, PatchSteadyRollingTest, testing::Values(12U, 16U, 20U));

}  // namespace
}  // namespace torsion::engine
