// Contact model mdr where no paraboloid fits the overlap: points, edges and corners.

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallModulus;
using test::make_ball_scene;
using test::make_part;
using test::options_of;

constexpr double kUpperFace = 0.1;  // m: of the body's upper face

/// A pyramid that stands on its apex, at the origin, whose faces have this slope against the plane.
PartDescription pyramid(std::uint32_t faces, double slope, double radius) {
  const double height = slope * radius * std::cos(std::numbers::pi / faces);
  PartDescription part = make_part(ShapeKind::kSphere, glm::dvec3(radius), {}, true, 4);
  SurfaceMesh& mesh = part.surface;
  mesh = SurfaceMesh{};
  mesh.positions = {glm::dvec3(0.0), glm::dvec3(0.0, height, 0.0)};
  for (std::uint32_t k = 0; k < faces; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.3) / faces;
    mesh.positions.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
  }
  for (std::uint32_t k = 0; k < faces; ++k) {
    const std::uint32_t here = 2 + k;
    const std::uint32_t next = 2 + (k + 1) % faces;
    mesh.triangles.emplace_back(0, here, next);
    mesh.triangles.emplace_back(1, next, here);
  }
  return part;
}

/// Normal force of a pyramid pressed into a half-space, over E* d^2 / slope.
double pyramid_force(std::uint32_t faces, double slope) {
  SceneDescription scene = make_ball_scene({.model = ContactModel::kMdr});
  scene.tools[0] = test::make_tool({pyramid(faces, slope, 0.03)});
  Hand hand(scene);
  const double depth = 0.2 * slope * 0.03;
  hand.step_to({{glm::dvec3(0.001, kUpperFace + 1e-3 * depth, 0.002), glm::dquat(1, 0, 0, 0)}});
  hand.move({0.0, -1.001 * depth, 0.0}, {0.0, 1.0, 0.0}, 0.0, 100);
  return hand.wrench().force.y * slope / (kBallModulus * depth * depth);
}

// From the overlap's area and mean depth, which 12 cells tell to 3 %.
TEST(MdrEdgesTest, ConesAndPyramidsPressAsTheExactOnes) {
  for (const double slope : {0.05, 0.15, 0.4}) {
    // Sneddon (Popov and Hess, 2015, 2.3): 2 / pi, of which that is 1.3 % less.
    EXPECT_NEAR(pyramid_force(64, slope) * std::numbers::pi / 2.0, 1.0, 0.05) << slope;
    // Bilodeau (J. Appl. Mech. 59 (1992) 519): 0.7453, of which it is 4.8 % less.
    EXPECT_NEAR(pyramid_force(4, slope) / 0.7453, 1.0, 0.08) << slope;
  }
}

/// Normal force of a box that is pressed 1 mm deep, turned by `tilt` about an axis askew to its
/// edges, at each tilt: with a corner and the faces beside it, then with an edge.
std::vector<double> forces_of_a_tilted_box(const BallScene& ball,
                                           const std::vector<double>& tilts) {
  const glm::dvec3 half(0.015, 0.012, 0.018);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 0.0, 0.25));
  SceneDescription scene = make_ball_scene(ball);
  scene.tools[0] = test::make_tool({make_part(ShapeKind::kBox, half)});
  Hand hand(scene, options_of(ball));
  std::vector<double> forces;
  for (const double tilt : tilts) {
    const glm::dquat turned = glm::angleAxis(tilt, axis);
    const glm::dmat3 columns = glm::mat3_cast(turned);
    const double lowest = std::abs(columns[0].y) * half.x + std::abs(columns[1].y) * half.y +
                          std::abs(columns[2].y) * half.z;
    hand.step_to({{glm::dvec3(0.0, kUpperFace + lowest - 1e-3, 0.0), turned}});
    forces.push_back(hand.wrench().force.y);
  }
  EXPECT_EQ(hand.clock().faults, 0U);
  return forces;
}

TEST(MdrEdgesTest, ABoxThatTiltsOntoACornerIsFeltAsByCells) {
  // From a face of which a corner is in the body to that corner alone, and on to an edge. The
  // overlap's area and mean depth give 7 to 18 % less than cells, whatever its shape; at its end
  // the contact is two of mdr's cells wide, of which each is worth some percent.
  std::vector<double> tilts;
  for (double tilt = 0.04; tilt < 0.8; tilt *= 1.01) {
    tilts.push_back(tilt);
  }
  const std::vector<double> springs = forces_of_a_tilted_box(
      {.model = ContactModel::kMdr, .static_friction = 0.0, .dynamic_friction = 0.0}, tilts);
  const std::vector<double> cells = forces_of_a_tilted_box(
      {.side = 40, .iterations = 8, .static_friction = 0.0, .dynamic_friction = 0.0}, tilts);
  constexpr std::size_t kArrived = 20;  // steps in which the force of a new contact fades in
  for (std::size_t k = kArrived; k + 1 < tilts.size(); ++k) {
    const double bend = springs[k] - 0.5 * (springs[k - 1] + springs[k + 1]);
    EXPECT_LT(std::abs(bend), 0.06 * springs[k]) << tilts[k];
    EXPECT_NEAR(springs[k] / cells[k], 1.0, 0.2) << tilts[k];
  }
}

}  // namespace
}  // namespace torsion::engine
