// Two tools beside each other on one elastic block, both sliding: each feels within a step how the
// block answers to the other.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

/// A plate or a puck, and a ball, over a block whose top is y = 0.
struct SideBySide {
  bool puck;
  glm::dvec2 half;  // m, of the plate along x and z; the puck's radius is the first
  double ball;      // m, radius
  double friction;
  double poisson_ratio;
  double plate_depth;  // m
  double ball_depth;   // m
  glm::dvec3 way;      // m, of the plate; the ball goes the opposite one
};

constexpr double kPlateHalf = 0.01;  // m, along y

SideBySide random_pair(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  SideBySide made;
  made.puck = seed % 2 != 0;
  made.half = {0.012 + 0.01 * share(random), 0.012 + 0.01 * share(random)};
  made.ball = 0.01 + 0.02 * share(random);
  made.friction = 0.02 * std::pow(10.0, share(random));
  made.poisson_ratio = 0.3 + 0.19 * share(random);
  made.plate_depth = 1e-4 * std::pow(10.0, share(random));
  made.ball_depth = 3e-4 * std::pow(10.0, share(random));
  made.way = 0.02 * glm::dvec3{share(random) - 0.5, 0.0, share(random) - 0.5};
  return made;
}

SceneDescription scene_of(const SideBySide& pair, ContactModel contact) {
  constexpr double kHigh = 0.05;  // m: half of the block
  SceneDescription scene;
  scene.bodies.push_back(test::make_body({test::make_part(
      ShapeKind::kBox, {0.05, kHigh, 0.04}, {glm::dvec3(0.0, -kHigh, 0.0), test::kUpright})}));
  BodyDescription& body = scene.bodies[0];
  body.models = {contact, BodyModel::kCompliance};
  body.models.region_threshold = 0.004;
  body.friction = {pair.friction, pair.friction};
  body.elasticity = {1e5, pair.poisson_ratio};
  const PartDescription plate =
      pair.puck ? test::make_part(ShapeKind::kCylinder, {pair.half.x, kPlateHalf, pair.half.x})
                : test::make_part(ShapeKind::kBox, {pair.half.x, kPlateHalf, pair.half.y});
  scene.tools.push_back(test::make_tool({plate}));
  scene.tools.push_back(
      test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(pair.ball))}));
  return scene;
}

struct Felt {
  std::vector<glm::dvec3> force[2];  // N, of each tool, in each step
};

/// Pressed in 100 steps while they slide, then sliding on for 300.
Felt slide(const SideBySide& pair, ContactModel contact) {
  constexpr int kSteps = 400;
  test::Hand hand(scene_of(pair, contact));
  Felt felt;
  for (int step = 0; step < kSteps; ++step) {
    const double pressed = std::min(1.0, step / 100.0);
    const glm::dvec3 way = pair.way * (static_cast<double>(step) / kSteps);
    constexpr double kGap = 1e-6;  // m
    const double plate = kPlateHalf + kGap - pair.plate_depth * pressed;
    const double ball = pair.ball + kGap - pair.ball_depth * pressed;
    hand.step_to({{glm::dvec3(-0.025, plate, 0.0) + way, test::kUpright},
                  {glm::dvec3(0.028, ball, 0.0) - way, test::kUpright}});
    for (std::uint32_t tool = 0; tool < 2; ++tool) {
      felt.force[tool].push_back(hand.wrench(tool).force);
    }
  }
  EXPECT_EQ(hand.clock().faults, 0U);
  return felt;
}

/// The largest |F_(k+1) - 2 F_k + F_(k-1)| after the press, of the force: what goes to and fro.
double swing_of(const std::vector<glm::dvec3>& force) {
  double most = 0.0;
  for (std::size_t k = 121; k + 1 < force.size(); ++k) {
    const glm::dvec3 bend = force[k + 1] - 2.0 * force[k] + force[k - 1];
    most = std::max(most, glm::length(bend) / glm::length(force[k]));
  }
  return most;
}

// While each met the other's answer a step late, the forces of four in ten of such pairs went to
// and fro by 5 to 35 %, or lost the contact: what both do to the block by friction, to turn it
// between them, came back twice. Such a swing grows until friction or the contact's end bounds it,
// so any bar between that and what new cells and new support fits leave, under 1 %, tells. That
// patch agrees shows that the steady force is the right one, not how exact it is: mdr takes the
// plate for an ellipse, and is up to 6 % from patch there.
TEST(SideBySideTest, TwoSlidingToolsPressSteadilyAndAsPatchHasIt) {
  for (unsigned seed = 0; seed < static_cast<unsigned>(test::trials_of(20, 7)); ++seed) {
    const SideBySide pair = random_pair(seed);
    const Felt mdr = slide(pair, ContactModel::kMdr);
    const Felt patch = slide(pair, ContactModel::kPatch);
    for (std::size_t tool = 0; tool < 2; ++tool) {
      EXPECT_LT(swing_of(mdr.force[tool]), 0.015) << "seed " << seed << ", tool " << tool;
      EXPECT_NEAR(mdr.force[tool].back().y / patch.force[tool].back().y, 1.0, 0.08)
          << "seed " << seed << ", tool " << tool;
    }
  }
}

}  // namespace
}  // namespace torsion::engine
