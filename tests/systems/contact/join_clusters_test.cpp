// One contact is one region, however few samples it has.

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "ecs/model_names.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine::test {
namespace {

using std::numbers::pi;

/// Of radii [m] `ring` and `tube`, about y.
PartDescription torus(double ring, double tube) {
  constexpr std::uint32_t kAround = 64;
  constexpr std::uint32_t kAcross = 32;
  PartDescription part = make_part(ShapeKind::kSphere, glm::dvec3(ring), {}, true);
  part.surface = {};
  const auto row = [](std::uint32_t i, std::uint32_t j) {
    return i % kAround * kAcross + j % kAcross;
  };
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double a = 2.0 * pi * i / kAround;
      const double b = 2.0 * pi * j / kAcross;
      const double radius = ring + tube * std::cos(b);
      part.surface.positions.emplace_back(radius * std::cos(a), tube * std::sin(b),
                                          radius * std::sin(a));
      part.surface.triangles.emplace_back(row(i, j), row(i, j + 1), row(i + 1, j + 1));
      part.surface.triangles.emplace_back(row(i, j), row(i + 1, j + 1), row(i + 1, j));
    }
  }
  return part;
}

/// A tool over the top face of a block, y = 0.1 m, of which only the contact deflects.
Hand over_block(PartDescription part, ContactModel contact, std::uint32_t side, const Pose& pose) {
  SceneDescription scene = ball_on_cube();
  scene.bodies[0].elasticity.youngs_modulus = 1e5;
  scene.bodies[0].elasticity.poisson_ratio = 0.45;
  scene.bodies[0].friction = {0.5, 0.5};
  scene.bodies[0].models = {contact, BodyModel::kNone};
  scene.tools = {make_tool({std::move(part)})};
  PrepareOptions options;
  options.settings.grid_side = side;
  Hand hand(scene, options);
  hand.step_to({pose});
  return hand;
}

struct Felt {
  double force = 0.0;   // N
  double torque = 0.0;  // N m
};

/// A ring pressed by half a millimetre and turned until it slips.
Felt press_and_turn_ring(std::uint32_t side) {
  Hand hand = over_block(torus(0.008, 0.003), ContactModel::kPatch, side,
                         {{0.0, 0.10302, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)});
  const glm::dvec3 up(0.0, 1.0, 0.0);
  hand.move({0.0, -5.2e-4, 0.0}, up, 0.0, 500);
  EXPECT_EQ(hand.world().state.regions.size(), 1U);
  hand.move(glm::dvec3(0.0), up, 0.5, 500);
  EXPECT_EQ(hand.world().state.regions.size(), 1U);
  return {hand.wrench().force.y, -hand.wrench().torque.y};
}

TEST(JoinClustersTest, ARingIsOneRegionAndAsFinerCellsHaveIt) {
  const Felt coarse = press_and_turn_ring(16);
  const Felt fine = press_and_turn_ring(40);
  // Two of the coarse cells lie across the ring's contact, twenty of them are as long as it is
  // around: half a cell of each rim is a tenth of its area, one rim's error against the other's.
  EXPECT_NEAR(coarse.force, fine.force, 0.05 * fine.force);
  EXPECT_NEAR(coarse.torque, fine.torque, 0.05 * fine.torque);
  // Slips all around: mu F times the ring's radius, less what is nearer to the axis.
  EXPECT_NEAR(fine.torque, 0.5 * fine.force * 0.008, 0.02 * fine.torque);
}

TEST(JoinClustersTest, ACornerIsOneRegion) {
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1.0));
  const glm::dvec3 down(0.0, -1.0, 0.0);
  const glm::dquat tilt =
      glm::angleAxis(std::acos(glm::dot(corner, down)), glm::normalize(glm::cross(corner, down)));
  for (const ContactModel contact : {ContactModel::kMdr, ContactModel::kPatch}) {
    for (const bool as_mesh : {false, true}) {
      Hand hand = over_block(make_part(ShapeKind::kBox, glm::dvec3(0.01), {}, as_mesh), contact, 16,
                             {{0.0, 0.10002 + 0.01 * std::numbers::sqrt3, 0.0}, tilt});
      const glm::dvec3 up(0.0, 1.0, 0.0);
      hand.move({0.0, -1e-3, 0.0}, up, 0.0, 500);
      for (int step = 0; step < 300; ++step) {
        hand.move(glm::dvec3(0.0), up, 1e-3, 1);
        ASSERT_EQ(hand.world().state.regions.size(), 1U) << step;
      }
    }
  }
}

// Only some of the samples of a cylinder's side come near the line along which it touches.
TEST(JoinClustersTest, ACylinderAlongACylinderIsOneRegionFromTheFirst) {
  constexpr double kColumn = 0.07;  // m, radii
  constexpr double kRoller = 0.03;
  constexpr double kClear = 1e-8;  // m
  constexpr double kPressedBy = 2e-5;
  for (const bool as_mesh : {false, true}) {
    for (const ContactModel contact :
         {ContactModel::kPaper, ContactModel::kMdr, ContactModel::kPatch}) {
      for (const double turned : {0.0, 0.3, 1.1}) {  // rad, about its axis
        SceneDescription scene = ball_on_cube();
        scene.bodies = {
            make_body({make_part(ShapeKind::kCylinder, {kColumn, 0.17, kColumn}, {}, as_mesh, 7)})};
        scene.bodies[0].models = {contact, BodyModel::kNone};
        scene.tools = {make_tool({make_part(ShapeKind::kCylinder, {kRoller, 0.05, kRoller})})};
        Hand hand(scene);
        const glm::dvec3 up(0.0, 1.0, 0.0);
        hand.step_to({{{kColumn + kRoller + kClear, 0.02, 0.0}, glm::angleAxis(turned, up)}});
        ASSERT_EQ(hand.world().state.regions.size(), 0U);
        hand.move({-kClear, 0.0, 0.0}, up, 0.0, 1);
        for (int step = 1; step <= 100; ++step) {
          hand.move({-kPressedBy / 100.0, 0.0, 0.0}, up, 0.0, 1);
          // The distance field of a mesh is a micrometre off.
          if (!as_mesh || step > 10) {
            ASSERT_EQ(hand.world().state.regions.size(), 1U)
                << name_of(contact) << ", turned by " << turned << ", step " << step;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace torsion::engine::test
