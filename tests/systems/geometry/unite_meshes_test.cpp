// Meshes that overlap bound one solid.

#include "systems/geometry/unite_meshes.hpp"

#include <cmath>
#include <map>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/distance_mesh.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine::test {
namespace {

SurfaceMesh box(const glm::dvec3& center, const glm::dvec3& half, bool inside_out = false) {
  SurfaceMesh mesh = tessellate(ShapeKind::kBox, half, 1);
  for (glm::dvec3& position : mesh.positions) {
    position += center;
  }
  for (glm::uvec3& triangle : mesh.triangles) {
    if (inside_out) {
      std::swap(triangle.y, triangle.z);
    }
  }
  return mesh;
}

SurfaceMesh together(SurfaceMesh a, const SurfaceMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const glm::uvec3& triangle : b.triangles) {
    a.triangles.push_back(triangle + first);
  }
  return a;
}

/// Divergence theorem.
double volume_of(const SurfaceMesh& mesh) {
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    volume +=
        glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z])) / 6.0;
  }
  return volume;
}

const glm::dvec3 kHalf(0.5, 0.4, 0.3);

TEST(UniteMeshesTest, BoxesThatOverlapHaveTheVolumeOfTheirUnion) {
  // Shifted along one, two and three axes; the last turned into no special position.
  for (const glm::dvec3& shift :
       {glm::dvec3(0.31, 0.0, 0.0), glm::dvec3(0.31, 0.23, 0.0), glm::dvec3(0.31, 0.23, 0.17)}) {
    const Result<Union> united = unite_shells(together(box({}, kHalf), box(shift, kHalf)));
    ASSERT_TRUE(united) << united.error().text;
    EXPECT_TRUE(united.value().changed);
    const glm::dvec3 shared = 2.0 * kHalf - shift;
    const double expected =
        2.0 * 8.0 * kHalf.x * kHalf.y * kHalf.z - shared.x * shared.y * shared.z;
    EXPECT_NEAR(volume_of(united.value().surface), expected, 1e-9);
  }
}

TEST(UniteMeshesTest, ABoxWithinABoxIsNothing) {
  const Result<Union> united = unite_shells(together(box({}, kHalf), box({}, 0.5 * kHalf)));
  ASSERT_TRUE(united) << united.error().text;
  EXPECT_TRUE(united.value().changed);
  EXPECT_NEAR(volume_of(united.value().surface), 8.0 * kHalf.x * kHalf.y * kHalf.z, 1e-12);
  EXPECT_EQ(united.value().surface.triangles.size(), box({}, kHalf).triangles.size());
}

TEST(UniteMeshesTest, ACavityAndShellsApartStayAsTheyAre) {
  EXPECT_FALSE(unite_shells(together(box({}, kHalf), box({}, 0.5 * kHalf, true))).value().changed);
  EXPECT_FALSE(unite_shells(together(box({}, kHalf), box({3.0, 0.0, 0.0}, kHalf))).value().changed);
  EXPECT_FALSE(unite_shells(box({}, kHalf)).value().changed);
}

TEST(UniteMeshesTest, BoxesThatTouchAlongAFaceHaveNoFaceThere) {
  const Result<Union> united = unite_shells(together(box({}, kHalf), box({1.0, 0.1, 0.05}, kHalf)));
  ASSERT_TRUE(united) << united.error().text;
  EXPECT_NEAR(volume_of(united.value().surface), 16.0 * kHalf.x * kHalf.y * kHalf.z, 1e-9);
  const Result<MeshDistance> distance = MeshDistance::build(united.value().surface);
  // In the middle of the face in which they touch.
  EXPECT_LT(distance.value().closest({0.5, 0.05, 0.02}).distance.value, -0.2);
}

TEST(UniteMeshesTest, RoundShellsAreCutToo) {
  // Two balls of 0.5 at a distance of 0.5: each loses a cap of height r / 2, 5/32 of its volume.
  SurfaceMesh other = tessellate(ShapeKind::kSphere, glm::dvec3(0.5), 12);
  const double ball = volume_of(other);
  for (glm::dvec3& position : other.positions) {
    position += glm::dvec3(0.5, 0.013, 0.027);
  }
  const Result<Union> united =
      unite_shells(together(tessellate(ShapeKind::kSphere, glm::dvec3(0.5), 12), other));
  ASSERT_TRUE(united) << united.error().text;
  EXPECT_NEAR(volume_of(united.value().surface) / ball, 2.0 - 2.0 * 5.0 / 32.0, 0.01);
}

// What overlaps of one mesh, and what overlaps as two parts, are felt as the same solid.
TEST(UniteMeshesTest, TwoPartsAreFeltAsOneMeshOfThem) {
  const auto force_of = [](bool as_parts) {
    SceneDescription scene = ball_on_cube();
    PartDescription cube = make_part(ShapeKind::kBox, glm::dvec3(0.05), {{0.0, 0.05, 0.0}}, true);
    PartDescription lump = make_part(ShapeKind::kBox, glm::dvec3(0.03), {{0.04, 0.09, 0.0}}, true);
    std::vector<PartDescription> parts{cube};
    if (as_parts) {
      parts.push_back(lump);
    } else {
      parts[0].surface = together(cube.surface, lump.surface);
    }
    for (PartDescription& part : parts) {
      part.shape.pose = Pose{};
    }
    scene.bodies = {make_body(parts)};
    scene.bodies[0].models.contact = ContactModel::kPatch;
    scene.bodies[0].models.body = BodyModel::kCompliance;
    Hand hand(scene);
    hand.step_to({{glm::dvec3(0.04, 0.171, 0.0), glm::dquat(1, 0, 0, 0)}});
    hand.move({0.0, -0.003, 0.0}, {0.0, 1.0, 0.0}, 0.0, 100);
    hand.move({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.0, 20);
    EXPECT_EQ(hand.clock().faults_ever, 0U);
    return hand.wrench().force.y;
  };
  const double whole = force_of(false);
  EXPECT_GT(whole, 1.0);
  EXPECT_NEAR(force_of(true), whole, 0.02 * whole);
}

}  // namespace
}  // namespace torsion::engine::test
