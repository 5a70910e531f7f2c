#include "scenes/closed_mesh.hpp"

#include <gtest/gtest.h>

#include "scenes/exact_shapes.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

/// Every triangle with three vertices of its own, as exporters write flat shading.
SurfaceMesh split(const SurfaceMesh& mesh) {
  SurfaceMesh apart;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.positions.size());
    for (int i = 0; i < 3; ++i) {
      apart.positions.push_back(mesh.positions[triangle[i]]);
    }
    apart.triangles.emplace_back(first, first + 1, first + 2);
  }
  return apart;
}

struct Checked {
  std::vector<Problem> found;
  SurfaceMesh mesh;
};

Checked check(const SurfaceMesh& mesh) {
  Checked checked;
  checked.mesh = closed_surface(mesh, "node \"n\"", {"f.gltf", checked.found});
  return checked;
}

TEST(ClosedMeshTest, SplitVerticesAreWelded) {
  const Checked checked = check(split(box_mesh({0.1, 0.2, 0.3})));
  EXPECT_TRUE(checked.found.empty()) << to_text(checked.found);
  EXPECT_EQ(checked.mesh.positions.size(), 8U);
  EXPECT_EQ(checked.mesh.triangles.size(), 12U);
}

TEST(ClosedMeshTest, WeldJoinsWithinTheToleranceOnly) {
  SurfaceMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5e-4, 0, 0}, {1, 2e-3, 0}, {0, 1, 5e-4}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const SurfaceMesh welded = weld(mesh, 1e-3);
  EXPECT_EQ(welded.positions.size(), 4U);  // only the second corners are farther apart than 1e-3
  EXPECT_EQ(welded.triangles[1], glm::uvec3(0, 3, 2));
}

TEST(ClosedMeshTest, WeldJoinsAcrossEveryAxisAndSign) {
  // Pairs that straddle 0 and pairs that differ along one axis each: none may be missed, whatever
  // cells or order the search uses.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {-1.0, -1e-9, 0.0, 0.37, 1.0}) {
      SurfaceMesh mesh;
      glm::dvec3 shift(0.0);
      shift[axis] = 0.9e-3;
      const glm::dvec3 p(at);
      mesh.positions = {p, p + glm::dvec3(1, 0, 0), p + glm::dvec3(0, 1, 0), p + shift,
                        p + glm::dvec3(0, 0, 2)};
      mesh.triangles = {{0, 1, 2}, {3, 4, 1}};
      EXPECT_EQ(weld(mesh, 1e-3).positions.size(), 4U) << axis << ' ' << at;
    }
  }
}

TEST(ClosedMeshTest, TrianglesThatWeldingFlattensAndUnusedVerticesGo) {
  SurfaceMesh mesh = box_mesh(glm::dvec3(1.0));
  mesh.positions.emplace_back(9.0, 9.0, 9.0);
  mesh.triangles.emplace_back(0, 0, 1);
  const SurfaceMesh welded = weld(mesh, 1e-9);
  EXPECT_EQ(welded.positions.size(), 8U);
  EXPECT_EQ(welded.triangles.size(), 12U);
}

TEST(ClosedMeshTest, VolumeOfABoxIsExactAndChangesSignInsideOut) {
  SurfaceMesh box = box_mesh({0.1, 0.2, 0.3});
  for (glm::dvec3& position : box.positions) {
    position += glm::dvec3(5.0, -3.0, 2.0);
  }
  // 8 * 0.1 * 0.2 * 0.3 m^3; away from the origin about 3 digits of 16 cancel.
  EXPECT_NEAR(enclosed_volume(box), 0.048, 1e-12);
  for (glm::uvec3& triangle : box.triangles) {
    std::swap(triangle.y, triangle.z);
  }
  EXPECT_NEAR(enclosed_volume(box), -0.048, 1e-12);
}

TEST(ClosedMeshTest, InsideOutMeshIsTurnedAbout) {
  SurfaceMesh box = box_mesh(glm::dvec3(0.1));
  for (glm::uvec3& triangle : box.triangles) {
    std::swap(triangle.y, triangle.z);
  }
  const Checked checked = check(box);
  EXPECT_TRUE(checked.found.empty()) << to_text(checked.found);
  EXPECT_NEAR(enclosed_volume(checked.mesh), 0.008, 1e-15);
}

TEST(ClosedMeshTest, HoleIsReportedWithItsEdgesAndAPlace) {
  SurfaceMesh box = box_mesh(glm::dvec3(0.5));
  box.triangles.erase(box.triangles.begin());  // corners (-,-,-), (-,-,+), (-,+,+)
  const Checked checked = check(box);
  ASSERT_EQ(checked.found.size(), 1U);
  const std::string text = to_text(checked.found);
  EXPECT_NE(text.find("node \"n\""), std::string::npos) << text;
  EXPECT_NE(text.find("3 edges"), std::string::npos) << text;
  EXPECT_NE(text.find("from (-0.5, -0.5, "), std::string::npos) << text;
}

TEST(ClosedMeshTest, TwoSolidsThatShareAnEdgeAreRefused) {
  SurfaceMesh boxes = box_mesh(glm::dvec3(0.5));
  for (const glm::uvec3& triangle : box_mesh(glm::dvec3(0.5)).triangles) {
    boxes.triangles.push_back(triangle + 8U);
  }
  for (const glm::dvec3& position : box_mesh(glm::dvec3(0.5)).positions) {
    boxes.positions.push_back(position + glm::dvec3(1.0, 1.0, 0.0));
  }
  const Checked checked = check(boxes);
  ASSERT_EQ(checked.found.size(), 1U);
  EXPECT_NE(to_text(checked.found).find("more than two triangles"), std::string::npos);
}

TEST(ClosedMeshTest, TwoSolidsApartAreOnePart) {
  SurfaceMesh boxes = box_mesh(glm::dvec3(0.5));
  for (const glm::uvec3& triangle : box_mesh(glm::dvec3(0.5)).triangles) {
    boxes.triangles.push_back(triangle + 8U);
  }
  for (const glm::dvec3& position : box_mesh(glm::dvec3(0.5)).positions) {
    boxes.positions.push_back(position + glm::dvec3(3.0, 0.0, 0.0));
  }
  EXPECT_TRUE(check(boxes).found.empty());
}

TEST(ClosedMeshTest, EmptyMeshIsRefused) {
  EXPECT_EQ(check(SurfaceMesh{}).found.size(), 1U);
}

TEST(ClosedMeshTest, SmallMeshFarFromItsOriginKeepsItsVertices) {
  SurfaceMesh box = box_mesh(glm::dvec3(1e-3));
  for (glm::dvec3& position : box.positions) {
    position += glm::dvec3(100.0);
  }
  const Checked checked = check(box);
  EXPECT_TRUE(checked.found.empty()) << to_text(checked.found);
  EXPECT_EQ(checked.mesh.positions.size(), 8U);
}

/// A cube whose faces are grids of `side` x `side` quads: many vertices share each coordinate.
SurfaceMesh gridded_cube(int side) {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int up : {0, 1}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (int i = 0; i <= side; ++i) {
        for (int j = 0; j <= side; ++j) {
          glm::dvec3 p(0.0);
          p[axis] = up;
          p[(axis + 1) % 3] = double(i) / side;
          p[(axis + 2) % 3] = double(j) / side;
          mesh.positions.push_back(p);
        }
      }
      const auto row = static_cast<std::uint32_t>(side + 1);
      for (std::uint32_t i = 0; i + 1 < row; ++i) {
        for (std::uint32_t j = 0; j + 1 < row; ++j) {
          const std::uint32_t a = first + i * row + j;
          glm::uvec3 one(a, a + row, a + row + 1);
          glm::uvec3 two(a, a + row + 1, a + 1);
          if (up == 0) {
            std::swap(one.y, one.z);
            std::swap(two.y, two.z);
          }
          mesh.triangles.push_back(one);
          mesh.triangles.push_back(two);
        }
      }
    }
  }
  return mesh;
}

TEST(ClosedMeshTest, GriddedCubeIsClosed) {
  const Checked checked = check(gridded_cube(20));
  EXPECT_TRUE(checked.found.empty()) << to_text(checked.found);
  EXPECT_EQ(checked.mesh.positions.size(), 6U * 20U * 20U + 2U);  // Euler: V = F / 2 + 2
}

}  // namespace
}  // namespace torsion::engine::test
