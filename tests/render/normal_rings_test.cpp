#include "render/normal_rings.hpp"

#include <cmath>
#include <map>
#include <tuple>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

std::vector<glm::vec4> rest_positions(const FrameWorld& frame, std::uint32_t body) {
  std::vector<glm::vec4> positions;
  for (const VertexRest& vertex :
       frame.body_vertices.rows<VertexRest>(frame.bodies.at<DrawRange>(body).vertices)) {
    positions.push_back(vertex.position);
  }
  return positions;
}

std::vector<glm::vec4> normals_of(const FrameWorld& frame, std::uint32_t body,
                                  const std::vector<glm::vec4>& positions) {
  std::vector<glm::vec4> normals(positions.size());
  vertex_normals(frame, make_normal_rings(frame), body, positions, normals);
  return normals;
}

FrameWorld one_body(const TestMesh& mesh) {
  return make_frame_world({{mesh, {}, glm::vec4(1.0F)}}, {});
}

using Place = std::tuple<float, float, float>;

Place place_of(const glm::vec3& point) {
  return {point.x, point.y, point.z};
}

/// The definition, in double and straight from the triangles: at each place the sum of the areas'
/// vectors of all triangles that touch it.
std::map<Place, glm::dvec3> smooth_normals(const TestMesh& mesh,
                                           const std::vector<glm::vec4>& positions) {
  std::map<Place, glm::dvec3> sums;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::dvec3 a(positions[triangle.x]);
    const glm::dvec3 area =
        glm::cross(glm::dvec3(positions[triangle.y]) - a, glm::dvec3(positions[triangle.z]) - a);
    for (const std::uint32_t corner : {triangle.x, triangle.y, triangle.z}) {
      sums[place_of(mesh.positions[corner])] += area;
    }
  }
  return sums;
}

TEST(NormalRingsTest, NormalsAreTheSumOfAreasAcrossSplitVertices) {
  const TestMesh mesh = sphere_mesh(0.03F, 9);  // its seams are split, its normals are one's own
  const FrameWorld frame = one_body(mesh);
  std::vector<glm::vec4> positions = rest_positions(frame, 0);
  for (glm::vec4& p : positions) {  // any smooth change of shape
    p += glm::vec4(0.2F * p.y, 0.01F * std::sin(90.0F * p.x), 3.0F * p.x * p.z, 0.0F);
  }
  const std::vector<glm::vec4> normals = normals_of(frame, 0, positions);
  auto expected = smooth_normals(mesh, positions);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const glm::dvec3 unit = glm::normalize(expected[place_of(mesh.positions[i])]);
    // Edges of 3 mm are differences of coordinates up to 3e-2 m, each right to 2e-9 m; their
    // cross products are then right to 4e-6 of their size. Three times that.
    EXPECT_NEAR(glm::distance(glm::dvec3(normals[i]), unit), 0.0, 1.2e-5) << i;
  }
}

/// The largest error of a sphere's normals, rad, n squares along a quarter turn.
double worst_sphere_normal(std::uint32_t n) {
  const TestMesh mesh = sphere_mesh(0.02F, n);
  const FrameWorld frame = one_body(mesh);
  const std::vector<glm::vec4> normals = normals_of(frame, 0, rest_positions(frame, 0));
  double worst = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    worst = std::max(worst, glm::distance(glm::dvec3(normals[i]), glm::dvec3(mesh.normals[i])));
  }
  return worst;
}

TEST(NormalRingsTest, SphereNormalsPointFromItsCentre) {
  // Where rings are lopsided (at the seams of the six faces) the error is of first order in the
  // size h of the triangles: below h / 2, and half as large for twice as many.
  const double coarse = worst_sphere_normal(24);
  const double fine = worst_sphere_normal(48);
  EXPECT_LT(coarse, 0.5 * glm::half_pi<double>() / 24.0);
  EXPECT_NEAR(fine / coarse, 0.5, 0.05);
}

TEST(NormalRingsTest, HardEdgesStayHard) {
  const TestMesh mesh = box_mesh(glm::vec3(0.02F, 0.03F, 0.04F), 3);
  const FrameWorld frame = one_body(mesh);
  const std::vector<glm::vec4> normals = normals_of(frame, 0, rest_positions(frame, 0));
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_LT(glm::distance(glm::vec3(normals[i]), mesh.normals[i]), 1e-6F) << i;
  }
}

TEST(NormalRingsTest, VertexWithoutAreaKeepsItsNormalAtRest) {
  TestMesh mesh = box_mesh(glm::vec3(0.02F), 1);
  mesh.positions.emplace_back(0.1F, 0.1F, 0.1F);  // in no triangle
  mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
  const FrameWorld frame = one_body(mesh);
  const std::vector<glm::vec4> normals = normals_of(frame, 0, rest_positions(frame, 0));
  EXPECT_EQ(normals.back(), glm::vec4(0.0F, 0.0F, 1.0F, 0.0F));
}

TEST(NormalRingsTest, EachNeighbourOfAClosedFanIsReadOncePlusItsStart) {
  const TestMesh mesh = sphere_mesh(1.0F, 4);
  const NormalRings rings = make_normal_rings(one_body(mesh));
  for (const glm::uvec2& range : rings.ranges) {
    // 3 (a box's corner) to 8 triangles, one fan each: a closed one has one entry more.
    EXPECT_GE(range.y, 4U);
    EXPECT_LE(range.y, 9U);
  }
}

TEST(NormalRingsTest, BodiesCountFromTheirOwnFirstVertex) {
  const TestMesh mesh = sphere_mesh(0.02F, 5);
  const FrameWorld frame =
      make_frame_world({{box_mesh(glm::vec3(0.01F), 2), {}, {}}, {mesh, {}, {}}}, {});
  const std::vector<glm::vec4> second = normals_of(frame, 1, rest_positions(frame, 1));
  const std::vector<glm::vec4> alone =
      normals_of(one_body(mesh), 0, rest_positions(one_body(mesh), 0));
  EXPECT_EQ(second, alone);
}

}  // namespace
}  // namespace torsion::engine
