#include "systems/surface/refine_mesh.hpp"

#include <array>
#include <cmath>
#include <map>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

/// A box of 24 vertices, each face with its own, held at its bottom.
DrawMesh box(const glm::vec3& half) {
  DrawMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const auto& [u, v] : {std::pair(-1.0F, -1.0F), std::pair(1.0F, -1.0F),
                                 std::pair(1.0F, 1.0F), std::pair(-1.0F, 1.0F)}) {
        glm::vec3 corner(0.0F);
        corner[axis] = side;
        corner[(axis + 1) % 3] = side * u;  // counter-clockwise from outside on both sides
        corner[(axis + 2) % 3] = v;
        glm::vec3 normal(0.0F);
        normal[axis] = side;
        mesh.positions.push_back(corner * half);
        mesh.normals.push_back(normal);
        mesh.fixed.push_back(corner.y < 0.0F);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
      mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
  }
  return mesh;
}

using Place = std::array<float, 3>;
Place place(const glm::vec3& p) {
  return {p.x, p.y, p.z};
}

double longest_edge(const DrawMesh& mesh) {
  double longest = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, glm::distance(glm::dvec3(mesh.positions[t[i]]),
                                                glm::dvec3(mesh.positions[t[(i + 1) % 3]])));
    }
  }
  return longest;
}

/// Closed, oriented, of that area and volume: no crack and no T.
void expect_same_solid(const DrawMesh& mesh, double area, double volume) {
  std::map<std::pair<Place, Place>, int> edges;
  double areas = 0.0;
  double volumes = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    std::array<glm::dvec3, 3> p;
    for (int i = 0; i < 3; ++i) {
      p[static_cast<std::size_t>(i)] = glm::dvec3(mesh.positions[t[i]]);
      ++edges[{place(mesh.positions[t[i]]), place(mesh.positions[t[(i + 1) % 3]])}];
    }
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    areas += 0.5 * glm::length(normal);
    volumes += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
    EXPECT_GT(glm::dot(normal, glm::dvec3(mesh.normals[t.x])), 0.0);
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
  EXPECT_NEAR(areas, area, 1e-5 * area);
  EXPECT_NEAR(volumes, volume, 1e-5 * volume);
}

TEST(RefineMeshTest, ACubeOfEightCornersGetsFacesThatShowADentAndStaysACube) {
  DrawMesh mesh = box(glm::vec3(0.05F));
  DrawnDetail detail;
  detail.everywhere = 0.1 / 16.0;
  detail.touched = true;
  detail.where = {{-0.01, 0.045, -0.01}, {0.01, 0.055, 0.01}};
  detail.there = 1e-3;
  refine_mesh(mesh, detail);
  EXPECT_LE(longest_edge(mesh), detail.everywhere);
  EXPECT_LE(mesh.triangles.size(), detail.most_triangles);
  expect_same_solid(mesh, 6.0 * 0.01, 1e-3);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.fixed.size(), mesh.positions.size());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    EXPECT_EQ(mesh.fixed[i], p.y < -0.0499F);
    inside += std::abs(p.x) < 0.01F && std::abs(p.z) < 0.01F && p.y > 0.0499F ? 1U : 0U;
  }
  // 20 x 20 mm with edges of at most a millimetre.
  EXPECT_GE(inside, 400U);
}

TEST(RefineMeshTest, AnyBoxStaysClosedWhereverItIsTouched) {
  std::minstd_rand random(7);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10'000) / 10'000.0;
  };
  for (int round = 0; round < 40; ++round) {
    const glm::dvec3 half(between(0.005, 0.1), between(0.005, 0.1), between(0.005, 0.1));
    DrawMesh mesh = box(glm::vec3(half));
    DrawnDetail detail;
    detail.everywhere = between(0.01, 0.1);
    detail.touched = true;
    const glm::dvec3 middle(between(-0.1, 0.1), between(-0.1, 0.1), between(-0.1, 0.1));
    detail.where = {middle - glm::dvec3(0.01), middle + glm::dvec3(0.01)};
    detail.there = between(5e-4, 5e-3);
    detail.most_triangles = 5000;
    refine_mesh(mesh, detail);
    EXPECT_LE(mesh.triangles.size(), detail.most_triangles);
    expect_same_solid(mesh, 8.0 * (half.x * half.y + half.y * half.z + half.z * half.x),
                      8.0 * half.x * half.y * half.z);
    // No angle gets below half of the smallest that was there (Rivara), here that of a face's
    // diagonal.
    const double slim = std::min({half.x, half.y, half.z}) / std::max({half.x, half.y, half.z});
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec3 a(mesh.positions[t.x]);
      const glm::dvec3 b(mesh.positions[t.y]);
      const glm::dvec3 c(mesh.positions[t.z]);
      const double longest =
          std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      const double height = glm::length(glm::cross(b - a, c - a)) / longest;
      ASSERT_GT(height / longest, 0.2 * slim) << round;
    }
  }
}

TEST(RefineMeshTest, WhatIsFineOrTooLargeStaysAsItIs) {
  const DrawMesh before = box(glm::vec3(0.05F));
  DrawMesh mesh = before;
  DrawnDetail detail;
  detail.everywhere = 0.2;
  refine_mesh(mesh, detail);
  EXPECT_EQ(mesh.triangles, before.triangles);
  detail.everywhere = 1e-6;
  detail.most_triangles = 11;  // of 12
  refine_mesh(mesh, detail);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(RefineMeshTest, WhereTheBoundIsTightEdgesAreLonger) {
  DrawMesh mesh = box(glm::vec3(0.05F));
  DrawnDetail detail;
  detail.everywhere = 1e-4;  // would be 12 million
  detail.most_triangles = 3000;
  refine_mesh(mesh, detail);
  EXPECT_LE(mesh.triangles.size(), 3000U);
  EXPECT_GE(mesh.triangles.size(), 700U);
  expect_same_solid(mesh, 6.0 * 0.01, 1e-3);
}

TEST(RefineMeshTest, TextureAndMaterialsStayWhereTheyAre) {
  DrawMesh mesh = box(glm::vec3(1.0F, 0.5F, 2.0F));
  for (const glm::vec3& p : mesh.positions) {
    mesh.texcoords.emplace_back(p.x + 2.0F * p.y, 3.0F * p.z);
    mesh.colors.emplace_back(p.x, p.y, 2.0F * p.z);
  }
  mesh.materials.resize(3);
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    mesh.triangle_materials.push_back(triangle / 4);  // an axis
  }
  DrawnDetail detail;
  detail.everywhere = 0.3;
  refine_mesh(mesh, detail);
  ASSERT_EQ(mesh.texcoords.size(), mesh.positions.size());
  ASSERT_EQ(mesh.triangle_materials.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    EXPECT_NEAR(mesh.texcoords[i].x, p.x + 2.0F * p.y, 1e-5);
    EXPECT_NEAR(mesh.texcoords[i].y, 3.0F * p.z, 1e-5);
    EXPECT_NEAR(glm::distance(mesh.colors[i], glm::vec3(p.x, p.y, 2.0F * p.z)), 0.0F, 1e-5F);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto axis = static_cast<int>(mesh.triangle_materials[i]);
    EXPECT_EQ(std::abs(mesh.normals[mesh.triangles[i].x][axis]), 1.0F);
  }
}

}  // namespace
}  // namespace torsion::engine
