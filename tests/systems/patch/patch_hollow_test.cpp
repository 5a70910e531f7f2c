// Contact model patch where the contact is no disc: a ring, and two lobes of one region. No closed
// form: pressures come from an independent dense solution on a finer grid.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/reference/dense_pressure.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallFriction;
using test::kBallModulus;
using test::kBallShearModulus;
using test::kUp;

constexpr double kRound = 0.05;  // m: radius of curvature of all shapes here

// A blunt ring: a body of revolution about y whose lower side is a parabola around a circle.
constexpr double kRing = 0.008;        // m: radius of the circle that touches first
constexpr double kRingDepth = 4.5e-4;  // m
constexpr double kOuter = 0.02;        // m

double ring_height(double rho) {
  return (rho - kRing) * (rho - kRing) / (2.0 * kRound);
}

SurfaceMesh ring_mesh() {
  // A quarter of a millimetre a step: chords lie 2e-7 m over the parabola, and as much around.
  constexpr std::uint32_t kRings = 80;
  constexpr std::uint32_t kAround = 240;
  constexpr double kTop = 0.02;  // m
  SurfaceMesh mesh;
  mesh.positions.emplace_back(0.0, ring_height(0.0), 0.0);
  for (std::uint32_t ring = 1; ring <= kRings + 1; ++ring) {
    const double rho = kOuter * std::min(ring, kRings) / kRings;
    const double height = ring > kRings ? kTop : ring_height(rho);
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kAround;
      mesh.positions.emplace_back(rho * std::cos(angle), height, rho * std::sin(angle));
    }
  }
  const auto row = [](std::uint32_t ring, std::uint32_t i) {
    return 1 + (ring - 1) * kAround + i % kAround;
  };
  const auto top = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.emplace_back(0.0, kTop, 0.0);
  for (std::uint32_t i = 0; i < kAround; ++i) {
    mesh.triangles.emplace_back(0, row(1, i), row(1, i + 1));
    for (std::uint32_t ring = 1; ring <= kRings; ++ring) {
      mesh.triangles.emplace_back(row(ring, i), row(ring + 1, i), row(ring + 1, i + 1));
      mesh.triangles.emplace_back(row(ring, i), row(ring + 1, i + 1), row(ring, i + 1));
    }
    mesh.triangles.emplace_back(top, row(kRings + 1, i + 1), row(kRings + 1, i));
  }
  return mesh;
}

ToolDescription ring_tool() {
  PartDescription part;
  part.node = "ring";
  part.shape.kind = ShapeKind::kMesh;
  part.surface = ring_mesh();
  return test::make_tool({part});
}

double ring_depth(double x, double y) {
  const double rho = std::hypot(x, y);
  return rho < kOuter ? kRingDepth - ring_height(rho) : -1.0;
}

// Two balls whose overlaps with the body have met, their lowest points y = 0.
constexpr double kLobe = 0.006;        // m from the middle
constexpr double kLobeDepth = 5.5e-4;  // m

ToolDescription lobed_tool() {
  std::vector<PartDescription> parts;
  for (const double x : {-kLobe, kLobe}) {
    parts.push_back(test::make_part(ShapeKind::kSphere, glm::dvec3(kRound),
                                    {glm::dvec3(x, kRound, 0.0), glm::dquat(1, 0, 0, 0)}));
  }
  return test::make_tool(parts);
}

double lobed_depth(double x, double y) {
  const double square = std::pow(std::abs(x) - kLobe, 2) + y * y;
  return kLobeDepth - (kRound - std::sqrt(kRound * kRound - square));
}

struct HollowCase {
  const char* name;
  ToolDescription (*tool)();
  double (*depth)(double x, double y);
  double deepest;
  double half;  // m: what the overlap fits in
};

const HollowCase kHollowCases[] = {
    {"Ring", ring_tool, ring_depth, kRingDepth, 0.016},
    {"TwoLobes", lobed_tool, lobed_depth, kLobeDepth, 0.0145},
};

struct Resolution {
  std::uint32_t side;
  double bound;  // of force and torque, relative
};

// A disc's torque is within 0.5 % at 120 to 150 cells and errs with nearly the square of a cell's
// size (patch_torsion_test.cpp), by its rim. Rings and pairs of lobes have up to twice as much rim
// for as many cells: 1 % at 16 a side. At 12, lobes have some four cells of radius each, and where
// those lie is worth 0.6 to 2.2 % (16 speeds of pressing).
constexpr Resolution kResolutions[] = {{12, 0.025}, {16, 0.01}, {24, 0.005}};

class PatchHollowTest : public testing::TestWithParam<HollowCase> {};

TEST_P(PatchHollowTest, PressesAndSpinsAsADenseSolutionSays) {
  const HollowCase& shape = GetParam();
  const reference::DensePressure rough =
      reference::dense_pressure(kBallModulus, shape.half, 24, shape.depth);
  const reference::DensePressure exact =
      reference::dense_pressure(kBallModulus, shape.half, 48, shape.depth);
  // The reference has converged: half the cells change it by 0.3 %, so that it is off by half of
  // that or less, as errors of the rim at least halve.
  EXPECT_NEAR(rough.force / exact.force, 1.0, 0.004);
  EXPECT_NEAR(rough.moment / exact.moment, 1.0, 0.004);
  EXPECT_EQ(exact.middle, 0.0);  // it is no disc
  for (const Resolution& resolution : kResolutions) {
    const BallScene ball{.side = resolution.side};
    SceneDescription scene = test::make_ball_scene(ball);
    scene.tools[0] = shape.tool();
    Hand hand(scene, test::options_of(ball));
    hand.step_to({{glm::dvec3(0.0, 0.1 + 1e-6, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
    hand.move({0.0, -1e-6 - shape.deepest, 0.0}, kUp, 0.0, 200);
    hand.move(glm::dvec3(0.0), kUp, 0.0, 20);
    EXPECT_NEAR(hand.wrench().force.y / exact.force, 1.0, resolution.bound) << resolution.side;
    // Everything slips around the axis, so each pressure has mu times its distance.
    hand.move(glm::dvec3(0.0), kUp, 0.4, 300);
    EXPECT_NEAR(-hand.wrench().torque.y / (kBallFriction * exact.moment), 1.0, resolution.bound)
        << resolution.side;
    EXPECT_EQ(hand.world().state.regions.size(), 1U);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, PatchHollowTest, testing::ValuesIn(kHollowCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace torsion::engine
