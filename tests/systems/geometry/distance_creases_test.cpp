// Distance fields at the sharp edges of meshes, wherever the field's grid cuts them, against the
// exact distance to the mesh.

#include "systems/geometry/distance_creases.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/distance_mesh.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"
#include "tests/systems/geometry/distance_meshes.hpp"
#include "tests/systems/geometry/field_world.hpp"

namespace torsion::engine {
namespace {

/// Errors of a field over its fine cell.
struct CreaseErrors {
  double largest = 0.0;
  double root_mean_square = 0.0;
};

/// A point on one of a mesh's triangles, or under it by up to `deepest`; every other one close to
/// one of the triangle's edges.
class FacePoints {
 public:
  FacePoints(const SurfaceMesh& mesh, double deepest) : mesh_(mesh), deepest_(deepest) {
    std::vector<double> areas;
    for (const glm::uvec3& triangle : mesh.triangles) {
      areas.push_back(glm::length(across(triangle)));
    }
    choose_ = std::discrete_distribution<std::size_t>(areas.begin(), areas.end());
  }

  template <class Random>
  glm::dvec3 next(Random& random) {
    const glm::uvec3& triangle = mesh_.triangles[choose_(random)];
    double along = share_(random);
    double off = share_(random);
    if (along + off > 1.0) {
      along = 1.0 - along;
      off = 1.0 - off;
    }
    close_ = !close_;
    off *= close_ ? 0.02 : 1.0;
    const glm::dvec3& corner = mesh_.positions[triangle.x];
    return corner + along * (mesh_.positions[triangle.y] - corner) +
           off * (mesh_.positions[triangle.z] - corner) -
           glm::normalize(across(triangle)) * deepest_ * share_(random);
  }

 private:
  [[nodiscard]] glm::dvec3 across(const glm::uvec3& triangle) const {
    const glm::dvec3& corner = mesh_.positions[triangle.x];
    return glm::cross(mesh_.positions[triangle.y] - corner, mesh_.positions[triangle.z] - corner);
  }

  const SurfaceMesh& mesh_;
  double deepest_;  // m
  std::discrete_distribution<std::size_t> choose_;
  std::uniform_real_distribution<double> share_{0.0, 1.0};
  bool close_ = false;
};

/// The worst of some ways in which a mesh may lie in its field's grid.
CreaseErrors errors_of(const SurfaceMesh& upright) {
  CreaseErrors worst;
  for (int trial = 0; trial < test::trials_of(8, 4); ++trial) {
    std::mt19937 random(static_cast<unsigned>(trial));
    std::normal_distribution<double> coordinate;
    const glm::dquat turn =
        trial == 0 ? test::kUpright
                   : glm::normalize(glm::dquat{coordinate(random), coordinate(random),
                                               coordinate(random), coordinate(random)});
    SurfaceMesh mesh = upright;
    for (glm::dvec3& position : mesh.positions) {
      position = turn * position;
    }
    const Result<BuiltField> field = build_distance_field(mesh);
    const Result<MeshDistance> exact = MeshDistance::build(mesh);
    EXPECT_TRUE(field.ok() && exact.ok());
    const World world = field_world(field.value());
    const DistanceField& header = field.value().header;
    const double cell = header.spacing / header.subdivision;
    FacePoints points(mesh, 0.5 * cell);
    constexpr int kPoints = 4000;
    double squares = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const glm::dvec3 p = points.next(random);
      const double found = FieldDistance(world.model, 0)(p.x, p.y, p.z).value;
      const double error = std::abs(found - exact.value().closest(p).distance.value) / cell;
      worst.largest = std::max(worst.largest, error);
      squares += error * error;
    }
    worst.root_mean_square = std::max(worst.root_mean_square, std::sqrt(squares / kPoints));
  }
  return worst;
}

// The half slopes of the smooth blend leave an eighth of a cell beside an edge of 90 degrees, and
// more beside a sharper one: 0.17 to 0.26 of a cell, 0.035 to 0.045 in the mean. The planes are the
// distance where a sample of the cell lies over each face that is nearest to some of its points.
// Where none does, which is within a part of the samples' distance, a third of the cell, of where
// faces meet, they are off by a part of that.
TEST(DistanceCreasesTest, FlatFacesAreFlatUpToTheirEdges) {
  struct Shape {
    const char* name;
    SurfaceMesh mesh;
  };
  const Shape shapes[] = {
      {"box", box_mesh({0.05, 0.03, 0.02})},
      {"plate", box_mesh({0.05, 0.003, 0.05})},
      {"wedge of 30 degrees", prism_mesh({{0.0, 0.0}, {0.1, 0.0}, {0.0866, 0.05}}, 0.03)},
      {"octahedron", sphere_mesh(0.05, 0)},
      {"cylinder of 12 sides", test::tessellate(ShapeKind::kCylinder, {0.05, 0.02, 0.05}, 3)},
  };
  for (const Shape& shape : shapes) {
    const CreaseErrors errors = errors_of(shape.mesh);
    EXPECT_LT(errors.largest, 0.06) << shape.name;
    EXPECT_LT(errors.root_mean_square, 0.006) << shape.name;
  }
}

// Where convex and concave edges meet in one cell neither the outermost nor the innermost planes
// are the distance: there it stays the smooth blend's.
TEST(DistanceCreasesTest, InnerEdgesAreSharpButForTheirEnds) {
  const CreaseErrors errors = errors_of(l_shape_mesh(0.05, 0.03));
  EXPECT_LT(errors.largest, 0.26);
  EXPECT_LT(errors.root_mean_square, 0.01);
}

// A radius that the cells resolve is no crease: what is smooth keeps the smooth blend, bit for bit.
TEST(DistanceCreasesTest, RoundThingsHaveNone) {
  for (const SurfaceMesh& mesh :
       {sphere_mesh(0.05, 5), torus_mesh(0.04, 0.015, 120, 60),
        test::tessellate(ShapeKind::kEllipsoid, {0.07, 0.05, 0.06}, 24)}) {
    const Result<BuiltField> field = build_distance_field(mesh);
    ASSERT_TRUE(field.ok());
    EXPECT_TRUE(field.value().creases.empty());
  }
}

}  // namespace
}  // namespace torsion::engine
