// Contacts that grow faster than a grid follows by its loaded cells, and those that are too long
// for a grid of square cells.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/patch/grid.hpp"
#include "systems/scratch.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallRadius;
using test::PressedBall;

struct Impact {
  double first;  // m: depth of the first step in contact
  double speed;  // m a step
};

class ImpactTest : public testing::TestWithParam<Impact> {};

// A ball that comes down fast is felt at its depth in every step: what the force is short of in a
// step is missing from the hand's stop. 2 %: the cells of a grid that a growing contact half fills
// (a staircase of six to eight cells over the radius), the first step's included.
TEST_P(ImpactTest, TheForceIsHertzInEveryStep) {
  PressedBall ball({.side = 0});
  double depth = GetParam().first;
  for (int step = 0; step < 30 && depth < 0.01 * kBallRadius; ++step) {
    ball.go(depth, glm::dvec2(0.0), 0.0, 1);
    EXPECT_NEAR(ball.normal_force() / ball.hertz().force, 1.0, 0.02) << step << " " << depth;
    depth += GetParam().speed;
  }
  EXPECT_EQ(ball.hand.clock().faults_ever, 0U);
}

INSTANTIATE_TEST_SUITE_P(Speeds, ImpactTest,
                         testing::Values(Impact{1e-6, 1e-5}, Impact{1e-6, 5e-5}, Impact{1e-6, 2e-4},
                                         Impact{1e-7, 3e-6}, Impact{3e-5, 1e-4},
                                         Impact{1e-5, 1.3e-5}));

/// A tool over the flat face y = 0 of a block, touching it first with a point, a line or a face.
struct Struck {
  const char* name;
  ShapeKind kind;
  glm::dvec3 half_extent;  // m
  glm::dquat rotation;
  bool as_mesh;
};

const glm::dvec3 kAboutX(1.0, 0.0, 0.0);
const glm::dvec3 kAboutY(0.0, 1.0, 0.0);
const glm::dvec3 kAboutZ(0.0, 0.0, 1.0);
const glm::dquat kUnturned(1.0, 0.0, 0.0, 0.0);
const glm::dquat kLying =
    glm::angleAxis(0.4, kAboutY) * glm::angleAxis(0.5 * std::numbers::pi, kAboutZ);
// A cube on a corner, its faces at different angles to the body.
const glm::dquat kOnCorner = glm::angleAxis(0.9553, kAboutX) *
                             glm::angleAxis(0.25 * std::numbers::pi, kAboutY) *
                             glm::angleAxis(0.3, kAboutZ);
const glm::dquat kOnEdge =
    glm::angleAxis(0.4, kAboutY) * glm::angleAxis(0.25 * std::numbers::pi, kAboutZ);
const glm::dquat kTilted =
    glm::angleAxis(0.9, kAboutY) * glm::angleAxis(0.04, glm::normalize(glm::dvec3(0.6, 0.0, 1.0)));

const Struck kStruck[] = {
    {"Ball", ShapeKind::kSphere, glm::dvec3(0.02), kUnturned, false},
    {"BallOfTriangles", ShapeKind::kSphere, glm::dvec3(0.02), kUnturned, true},
    {"Ellipsoid", ShapeKind::kEllipsoid, {0.03, 0.02, 0.01}, kUnturned, false},
    {"LyingCylinder", ShapeKind::kCylinder, {0.01, 0.015, 0.01}, kLying, false},
    {"LyingCylinderOfTriangles", ShapeKind::kCylinder, {0.01, 0.015, 0.01}, kLying, true},
    {"StandingCylinder", ShapeKind::kCylinder, {0.01, 0.015, 0.01}, kUnturned, false},
    {"Capsule", ShapeKind::kCapsule, {0.01, 0.025, 0.01}, kLying, false},
    {"CubeOnACorner", ShapeKind::kBox, glm::dvec3(0.01), kOnCorner, false},
    {"CubeOnAnEdge", ShapeKind::kBox, glm::dvec3(0.01), kOnEdge, false},
    {"TiltedPlate", ShapeKind::kBox, {0.02, 0.004, 0.013}, kTilted, false},
    {"TiltedPlateOfTriangles", ShapeKind::kBox, {0.02, 0.004, 0.013}, kTilted, true},
    {"Plate", ShapeKind::kBox, {0.02, 0.004, 0.013}, kUnturned, false},
};

void PrintTo(const Struck& tool, std::ostream* out) {
  *out << tool.name;
}

/// How far the tool reaches under its centre, m.
double reach_down(const Struck& tool) {
  if (tool.kind == ShapeKind::kBox) {
    return glm::dot(glm::abs(glm::conjugate(tool.rotation) * kAboutY), tool.half_extent);
  }
  return tool.rotation == kLying ? tool.half_extent.x : tool.half_extent.y;
}

/// Forces of a tool that comes down at so many m a step, from its second step in contact on: each
/// step is made in so many.
std::vector<double> strike(const Struck& tool, double speed, int finer) {
  constexpr double kDeepest = 1.2e-3;  // m
  constexpr double kFirst = 1e-6;      // m
  constexpr int kMostSteps = 30;
  const glm::dvec3 block(0.06, 0.05, 0.06);
  SceneDescription scene;
  scene.bodies.push_back(test::make_body(
      {test::make_part(ShapeKind::kBox, block, {glm::dvec3(0.0, -block.y, 0.0), kUnturned})}));
  scene.bodies[0].elasticity = {2e5, 0.45, 1000.0};
  scene.bodies[0].friction = {0.7, 0.7};
  scene.bodies[0].models.contact = ContactModel::kPatch;
  scene.bodies[0].models.body = BodyModel::kNone;
  scene.bodies[0].models.region_threshold = 0.01;
  scene.tools.push_back(test::make_tool({test::make_part(
      tool.kind, tool.half_extent, {glm::dvec3(0.0), tool.rotation}, tool.as_mesh)}));
  Hand hand(scene);
  const double height = reach_down(tool);
  const auto go_to = [&](double depth) {
    hand.step_to({{glm::dvec3(0.0, height - depth, 0.0), kUnturned}});
  };
  go_to(-kFirst);
  go_to(kFirst);
  std::vector<double> forces;
  const int steps = std::min(kMostSteps, static_cast<int>(kDeepest / speed));
  for (int step = 1; step < steps; ++step) {
    for (int k = 1; k <= finer; ++k) {
      go_to(kFirst + (step - 1 + static_cast<double>(k) / finer) * speed);
    }
    forces.push_back(hand.wrench().force.y);
  }
  EXPECT_EQ(hand.clock().faults_ever, 0U);
  return forces;
}

class StruckTest : public testing::TestWithParam<Struck> {};

// Whatever a tool's shape, and at whatever speed it comes: 20 to 300 um a step, after a first
// micrometre. Contacts of corners and edges take all their width from the depth, so a step makes
// them up to three hundred times as wide; grids that only followed their loaded cells gave them 1 %
// of their force. 10 %: two grids of 16 cells a side, of which a corner's contact fills a third,
// lie a cell apart at most.
TEST_P(StruckTest, IsFeltAsInFinerSteps) {
  constexpr int kFiner = 16;
  for (const double speed : {2e-5, 1e-4, 3e-4}) {
    const std::vector<double> coarse = strike(GetParam(), speed, 1);
    const std::vector<double> fine = strike(GetParam(), speed, kFiner);
    for (std::size_t step = 0; step < coarse.size(); ++step) {
      EXPECT_GT(fine[step], 0.0) << speed << " " << step;
      EXPECT_NEAR(coarse[step] / fine[step], 1.0, 0.1) << speed << " " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tools, StruckTest, testing::ValuesIn(kStruck),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// What an edge of a square bar, askew by an angle, finds in a ball that it has just touched.
struct EdgeContact {
  double force = 0.0;  // N
  double area = 0.0;   // m^2, of the overlap
};

constexpr double kEdgeBall = 0.05;  // m: radius

/// @param side  cells along a side of the grid, 0 for the usual
std::vector<EdgeContact> press_edge(double askew, std::uint32_t side,
                                    const std::vector<double>& depths) {
  constexpr double kHalf = 0.02;  // m: of the bar's sides
  const glm::dquat upright(1.0, 0.0, 0.0, 0.0);
  const glm::dquat on_edge = glm::angleAxis(0.25 * std::numbers::pi, glm::dvec3(0.0, 0.0, 1.0));
  SceneDescription scene;
  scene.bodies.push_back(test::make_body(
      {test::make_part(ShapeKind::kSphere, glm::dvec3(kEdgeBall), {glm::dvec3(0.0), upright})}));
  scene.bodies[0].models.contact = ContactModel::kPatch;
  scene.tools.push_back(test::make_tool({test::make_part(
      ShapeKind::kBox, glm::dvec3(kHalf, kHalf, 2.0 * kEdgeBall), {glm::dvec3(0.0), on_edge})}));
  PrepareOptions options;
  options.settings.grid_side = side;
  Hand hand(scene, options);
  const auto go_to = [&](double depth) {
    const double height = kEdgeBall + std::numbers::sqrt2 * kHalf - depth;
    hand.step_to(
        {{glm::dvec3(0.0, height, 0.0), glm::angleAxis(askew, glm::dvec3(0.0, 1.0, 0.0))}});
  };
  go_to(-depths.front());
  std::vector<EdgeContact> found;
  for (const double depth : depths) {
    go_to(depth);
    EXPECT_EQ(hand.world().state.regions.size(), 1U);
    found.push_back({hand.wrench().force.y, hand.world().state.regions.at<Overlap>(0).area});
  }
  EXPECT_EQ(hand.clock().faults_ever, 0U);
  return found;
}

// The overlap is a band of 2 sqrt(2 R d) by 2 d: 316 times as long as wide at a micrometre, 100
// times at ten. Twelve cells of at most 16 : 1 along it are then 1.6 and half times as wide as it
// is, so against 48 that it fills the force is some 20 % too large; a grid that holds a part of it
// only has a tenth to a half, and one between whose columns it lies none. How it lies is nothing to
// a ball: 6 %, for a band whose middle is a tenth of a cell beside a column's.
TEST(EdgeInABallTest, IsFeltAlikeHoweverItLiesAndFromItsFirstStep) {
  const std::vector<double> depths{1e-6, 1e-5};
  const std::vector<EdgeContact> fine = press_edge(0.0, 48, depths);
  const std::vector<EdgeContact> along = press_edge(0.0, 0, depths);
  for (const double askew : {0.0, 0.3, 0.785, 1.2}) {
    const std::vector<EdgeContact> found = press_edge(askew, 0, depths);
    for (std::size_t k = 0; k < depths.size(); ++k) {
      EXPECT_NEAR(found[k].force / fine[k].force, 1.0, 0.3) << askew << " " << depths[k];
      EXPECT_NEAR(found[k].force / along[k].force, 1.0, 0.1) << askew << " " << depths[k];
    }
    // Depth d (1 - s^2) at s of the half length, and twice that wide: half a cell at the middle, of
    // which a half as much more counts at most.
    const double length = std::sqrt(2.0 * kEdgeBall * depths[1]);
    EXPECT_NEAR(found[1].area / (8.0 / 3.0 * depths[1] * length), 1.0, 0.5) << askew;
  }
}

// A contact that other tools push the material out of has neither points nor a force for a while.
TEST(ContactWithoutPointsTest, ItsGridStaysWhereTheToolWas) {
  PressedBall ball({.side = 12});
  ball.press(test::kBallDepth, 50);
  Simulation& simulation = ball.hand.simulation();
  State& state = simulation.world.state;
  const RegionFrame before = state.regions.at<RegionFrame>(0);
  state.regions.at<RegionNormal>(0).force = 0.0;
  StepContext context = simulation.scratch->context(simulation.world.model, state, ball.hand.poses);
  follow_patch(context, 0, RegionPoints{});
  const RegionFrame& frame = state.regions.at<RegionFrame>(0);
  EXPECT_EQ(frame.origin, before.origin);
  EXPECT_EQ(frame.normal, before.normal);
  EXPECT_EQ(frame.half_size, before.half_size);
}

}  // namespace
}  // namespace torsion::engine
