// The meshes of a report's runs: far fewer vertices, the same shape.

#include "app/report/coarse_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/report/shapes.hpp"

namespace torsion::engine {
namespace {

constexpr float kCell = 0.02F;  // m
constexpr float kFine = 0.025F;

TEST(CoarseMeshTest, ABlockKeepsItsCornersAndAllThatIsNear) {
  const DrawMesh block =
      drawn({shape_surface(ShapeKind::kBox, {0.05, 0.05, 0.05}, 61)}, false, glm::vec4(1.0F));
  const glm::vec3 top(0.0F, 0.05F, 0.0F);
  const DrawMesh coarse = coarse_mesh(block, top, kFine, kCell);
  EXPECT_LT(coarse.positions.size(), block.positions.size() / 50);
  const auto has = [&](const glm::vec3& place, const glm::vec3& normal) {
    for (std::size_t i = 0; i < coarse.positions.size(); ++i) {
      if (glm::distance(coarse.positions[i], place) < 1e-6F && coarse.normals[i] == normal) {
        return true;
      }
    }
    return false;
  };
  for (std::size_t i = 0; i < block.positions.size(); ++i) {
    const glm::vec3 size = glm::abs(block.positions[i]);
    const bool is_corner = std::min({size.x, size.y, size.z}) > 0.05F - 1e-6F;
    if (is_corner || glm::distance(block.positions[i], top) < kFine) {
      EXPECT_TRUE(has(block.positions[i], block.normals[i])) << i;
    }
  }
  // Its faces are where they were: what is left of them lies in them, and covers them. A few
  // triangles are folded over, which counts against them.
  double area = 0.0;
  for (const glm::uvec3& t : coarse.triangles) {
    const glm::dvec3 a(coarse.positions[t.x]);
    const glm::dvec3 across =
        glm::cross(glm::dvec3(coarse.positions[t.y]) - a, glm::dvec3(coarse.positions[t.z]) - a);
    const double along = glm::dot(across, glm::dvec3(coarse.normals[t.x]));
    EXPECT_NEAR(std::abs(along), glm::length(across), 1e-10);
    area += 0.5 * along;
  }
  EXPECT_NEAR(area, 6.0 * 0.1 * 0.1, 1e-6);
}

TEST(CoarseMeshTest, ABallStaysRound) {
  const DrawMesh ball =
      drawn({shape_surface(ShapeKind::kSphere, glm::dvec3(0.05), 41)}, true, glm::vec4(1.0F));
  const DrawMesh coarse = coarse_mesh(ball, glm::vec3(0.0F), 0.0F, 0.1F / 18.0F);
  EXPECT_LT(coarse.positions.size(), ball.positions.size() / 20);
  // A mean of vertices that are half a cell's diagonal apart lies below the sphere by the height of
  // that arc: c^2 / (2 R).
  const float cell = 0.1F / 18.0F;
  const float below = 0.75F * cell * cell / (2.0F * 0.05F);
  for (std::size_t i = 0; i < coarse.positions.size(); ++i) {
    EXPECT_NEAR(glm::length(coarse.positions[i]), 0.05F - 0.5F * below, 0.5F * below + 1e-6F);
    EXPECT_GT(glm::dot(coarse.positions[i], coarse.normals[i]), 0.045F);
  }
}

}  // namespace
}  // namespace torsion::engine
