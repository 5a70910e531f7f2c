#include "scenes/mass_properties.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/exact_shapes.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

PartDescription box_part(const glm::dvec3& half_extent, const glm::dvec3& center) {
  PartDescription part;
  part.surface = box_mesh(half_extent);
  for (glm::dvec3& position : part.surface.positions) {
    position += center;
  }
  return part;
}

TEST(MassPropertiesTest, CuboidAwayFromTheOriginHasItsTensorAboutItsCenter) {
  const glm::dvec3 center(0.3, -0.2, 0.5);
  const std::vector<PartDescription> parts = {box_part({0.1, 0.2, 0.3}, center)};
  const MassProperties properties = mass_properties(parts, 5.0);
  EXPECT_EQ(properties.mass, 5.0);
  EXPECT_LE(glm::distance(properties.center, center), 1e-14);
  // m (b^2 + c^2) / 12 with edges b and c; moments about the origin cancel to about 1e-13.
  EXPECT_NEAR(properties.inertia[0][0], 5.0 * (0.16 + 0.36) / 12.0, 1e-12);
  EXPECT_NEAR(properties.inertia[1][1], 5.0 * (0.04 + 0.36) / 12.0, 1e-12);
  EXPECT_NEAR(properties.inertia[2][2], 5.0 * (0.04 + 0.16) / 12.0, 1e-12);
  EXPECT_NEAR(properties.inertia[0][1], 0.0, 1e-12);
  EXPECT_NEAR(properties.inertia[1][2], 0.0, 1e-12);
  EXPECT_NEAR(properties.inertia[2][0], 0.0, 1e-12);
}

TEST(MassPropertiesTest, SphereHasTwoFifthsMassTimesRadiusSquared) {
  ShapePart shape;
  shape.kind = ShapeKind::kSphere;
  shape.half_extent = glm::dvec3(0.05);
  PartDescription part;
  part.surface = tessellate(shape);
  const MassProperties properties = mass_properties({&part, 1}, 2.0);
  const double expected = 0.4 * 2.0 * 0.05 * 0.05;
  for (int i = 0; i < 3; ++i) {
    // The inscribed polyhedron's edges are up to 2 pi / 96 * 1.4 of the radius: its surface lies up
    // to 0.1 % inside, and the moment goes with the square.
    EXPECT_NEAR(properties.inertia[i][i], expected, 0.002 * expected);
  }
}

TEST(MassPropertiesTest, TwoPartsShareTheMassByTheirVolumes) {
  const std::vector<PartDescription> parts = {box_part(glm::dvec3(0.1), {-1.0, 0.0, 0.0}),
                                              box_part(glm::dvec3(0.1), {1.0, 0.0, 0.0})};
  const MassProperties properties = mass_properties(parts, 2.0);
  EXPECT_LE(glm::length(properties.center), 1e-14);
  const double own = 1.0 * (0.04 + 0.04) / 12.0;  // one cube of 1 kg and edge 0.2 m
  EXPECT_NEAR(properties.inertia[0][0], 2.0 * own, 1e-13);
  EXPECT_NEAR(properties.inertia[1][1], 2.0 * (own + 1.0), 1e-12);  // 1 m away from the middle
}

TEST(MassPropertiesTest, MovingTheCenterAddsTheParallelAxes) {
  const std::vector<PartDescription> parts = {box_part(glm::dvec3(0.1), glm::dvec3(0.0))};
  MassProperties properties = mass_properties(parts, 3.0);
  const double own = properties.inertia[0][0];
  move_mass_center(properties, {0.0, 0.5, 0.0});
  EXPECT_EQ(properties.center, glm::dvec3(0.0, 0.5, 0.0));
  EXPECT_NEAR(properties.inertia[0][0], own + 3.0 * 0.25, 1e-13);
  EXPECT_NEAR(properties.inertia[1][1], own, 1e-13);
  EXPECT_NEAR(properties.inertia[2][2], own + 3.0 * 0.25, 1e-13);
}

}  // namespace
}  // namespace torsion::engine::test
