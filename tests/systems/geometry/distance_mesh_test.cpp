#include "systems/geometry/distance_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance_shapes.hpp"
#include "tests/systems/geometry/distance_meshes.hpp"

namespace torsion::engine {
namespace {

MeshDistance built(const SurfaceMesh& mesh) {
  Result<MeshDistance> result = MeshDistance::build(mesh);
  EXPECT_TRUE(result.ok());
  return std::move(result).value();
}

std::vector<glm::dvec3> points_in_box(double half, int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-half, half);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(random);
    const double y = coordinate(random);
    const double z = coordinate(random);
    points.emplace_back(x, y, z);
  }
  return points;
}

double to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a;
  const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::distance(p, a + t * ab);
}

/// Distance to a triangle another way: to its plane where the foot is inside, else to its edges.
double to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                   const glm::dvec3& c) {
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const double height = glm::dot(p - a, normal);
  const glm::dvec3 foot = p - height * normal;
  const auto left_of = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, foot - from), normal) >= 0.0;
  };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) {
    return std::abs(height);
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

double brute_distance(const SurfaceMesh& mesh, const glm::dvec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::uvec3& t : mesh.triangles) {
    nearest = std::min(
        nearest, to_triangle(p, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]));
  }
  return nearest;
}

/// Whole turns of the surface seen from a point, from the solid angles of its triangles (van
/// Oosterom and Strackee 1983): 1 inside, 0 outside. Knows nothing of nearest points and normals.
double winding(const SurfaceMesh& mesh, const glm::dvec3& p) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.positions[t.x] - p;
    const glm::dvec3 b = mesh.positions[t.y] - p;
    const glm::dvec3 c = mesh.positions[t.z] - p;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    sum += 2.0 *
           std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                         glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

struct Named {
  std::string name;
  SurfaceMesh mesh;
};

/// Round, edged, with a hole, with an inner edge, and a wedge whose edge is sharper than 4 degrees.
std::vector<Named> meshes() {
  return {{"sphere", sphere_mesh(0.05, 3)},
          {"box", box_mesh({0.05, 0.03, 0.02})},
          {"torus", torus_mesh(0.04, 0.015, 24, 12)},
          {"l shape", l_shape_mesh(0.05, 0.02)},
          {"wedge", prism_mesh({{-0.05, -0.0015}, {0.05, 0.0}, {-0.05, 0.0015}}, 0.03)}};
}

TEST(MeshDistanceTest, IsTheSmallestDistanceToATriangleWithTheSignOfTheWindingNumber) {
  for (const Named& named : meshes()) {
    SCOPED_TRACE(named.name);
    const MeshDistance distance = built(named.mesh);
    for (const glm::dvec3& p : points_in_box(0.08, 500, 1)) {
      const MeshDistance::Closest closest = distance.closest(p);
      // Rounding of coordinates of 0.1 m and of barycentric weights: 1e-16 m, times some ten.
      EXPECT_NEAR(std::abs(closest.distance.value), brute_distance(named.mesh, p), 1e-15);
      EXPECT_EQ(closest.distance.value<0.0, winding(named.mesh, p)> 0.5);
      EXPECT_NEAR(glm::distance(closest.point, p), std::abs(closest.distance.value), 1e-15);
      EXPECT_NEAR(
          glm::distance(p - closest.distance.value * closest.distance.gradient, closest.point), 0.0,
          1e-15);
      ASSERT_LT(closest.triangle, named.mesh.triangles.size());
    }
  }
}

TEST(MeshDistanceTest, SignIsRightWhereEdgesAndCornersAreNearest) {
  // Points straight off vertices and edge middles, on both sides, where a face's normal alone can
  // lie.
  for (const Named& named : meshes()) {
    SCOPED_TRACE(named.name);
    const MeshDistance distance = built(named.mesh);
    std::vector<glm::dvec3> features;
    for (const glm::uvec3& t : named.mesh.triangles) {
      features.push_back(named.mesh.positions[t.x]);
      features.push_back(0.5 * (named.mesh.positions[t.x] + named.mesh.positions[t.y]));
      if (features.size() > 200) {
        break;
      }
    }
    for (const glm::dvec3& feature : features) {
      for (const glm::dvec3& direction : points_in_box(1e-4, 8, 2)) {
        const glm::dvec3 p = feature + direction;
        EXPECT_EQ(distance.closest(p).distance.value<0.0, winding(named.mesh, p)> 0.5);
      }
    }
  }
}

TEST(MeshDistanceTest, MeshOfABoxIsTheExactBox) {
  const glm::dvec3 half(0.05, 0.03, 0.08);
  const MeshDistance distance = built(box_mesh(half));
  const BoxDistance exact{half};
  for (const glm::dvec3& p : points_in_box(0.12, 1000, 3)) {
    const Distance expected = exact(p.x, p.y, p.z);
    const Distance found = distance.closest(p).distance;
    EXPECT_NEAR(found.value, expected.value, 1e-15);
    EXPECT_NEAR(glm::distance(found.gradient, expected.gradient), 0.0, 1e-12);
  }
}

TEST(MeshDistanceTest, GradientOnTheSurfaceIsTheNormal) {
  const MeshDistance distance = built(box_mesh(glm::dvec3(0.05)));
  const auto gradient_at = [&](const glm::dvec3& p) {
    return distance.closest(p).distance.gradient;
  };
  EXPECT_NEAR(glm::distance(gradient_at({0.05, 0.01, 0.02}), {1.0, 0.0, 0.0}), 0.0, 1e-12);
  // Pseudonormals of a cube's edge and corner halve its right angles.
  EXPECT_NEAR(
      glm::distance(gradient_at({0.05, 0.05, 0.02}), glm::normalize(glm::dvec3(1.0, 1.0, 0.0))),
      0.0, 1e-12);
  EXPECT_NEAR(glm::distance(gradient_at(glm::dvec3(0.05)), glm::normalize(glm::dvec3(1.0))), 0.0,
              1e-12);
}

TEST(MeshDistanceTest, AHintChangesNothing) {
  const SurfaceMesh mesh = torus_mesh(0.04, 0.015, 24, 12);
  const MeshDistance distance = built(mesh);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::uint32_t hint = 0;
  for (const glm::dvec3& p : points_in_box(0.08, 500, 4)) {
    hint = (hint * 31 + 7) % count;
    const MeshDistance::Closest without = distance.closest(p);
    const MeshDistance::Closest with = distance.closest(p, hint);
    EXPECT_EQ(without.distance.value, with.distance.value);
    EXPECT_NEAR(glm::distance(without.point, with.point), 0.0, 1e-15);
  }
}

TEST(MeshDistanceTest, WorksFarFromTheOrigin) {
  // The tree of boxes is float: a mesh 100 m away must be as exact as one here.
  SurfaceMesh mesh = box_mesh(glm::dvec3(0.05));
  const glm::dvec3 shift(100.0, -50.0, 70.0);
  for (glm::dvec3& position : mesh.positions) {
    position += shift;
  }
  const MeshDistance distance = built(mesh);
  const BoxDistance exact{glm::dvec3(0.05)};
  for (const glm::dvec3& p : points_in_box(0.1, 300, 6)) {
    // Coordinates of 100 m are rounded to 1.4e-14 m.
    EXPECT_NEAR(distance.closest(p + shift).distance.value, exact(p.x, p.y, p.z).value, 1e-13);
  }
}

TEST(MeshDistanceTest, RefusesWhatIsNoMesh) {
  const auto refusal_of = [](const SurfaceMesh& mesh) {
    const Result<MeshDistance> result = MeshDistance::build(mesh);
    return result.ok() ? std::string() : result.error().text;
  };
  SurfaceMesh mesh = box_mesh(glm::dvec3(0.05));
  EXPECT_EQ(refusal_of(mesh), "");
  EXPECT_NE(refusal_of(SurfaceMesh{}).find("no triangles"), std::string::npos);
  SurfaceMesh bad_index = mesh;
  bad_index.triangles[5].y = 8;
  EXPECT_NE(refusal_of(bad_index).find("triangle 5 names vertex 8"), std::string::npos);
  SurfaceMesh bad_position = mesh;
  bad_position.positions[3].z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal_of(bad_position).find("position 3"), std::string::npos);
}

}  // namespace
}  // namespace torsion::engine
