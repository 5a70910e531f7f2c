#pragma once

// Closed meshes whose exact surface is known, for tests and benchmarks of distances.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "ecs/surface.hpp"

namespace torsion::engine {

/// A sphere about the origin whose vertices lie on it: an octahedron cut `levels` times, 8 *
/// 4^levels triangles.
inline SurfaceMesh sphere_mesh(double radius, std::uint32_t levels) {
  SurfaceMesh mesh;
  mesh.positions = {glm::dvec3(1, 0, 0),  glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0),
                    glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1),  glm::dvec3(0, 0, -1)};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (std::uint32_t level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, added] = middles.try_emplace(std::minmax(a, b), mesh.positions.size());
      if (added) {
        mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
      }
      return entry->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : mesh.triangles) {
      const std::uint32_t ab = middle(t.x, t.y);
      const std::uint32_t bc = middle(t.y, t.z);
      const std::uint32_t ca = middle(t.z, t.x);
      finer.insert(finer.end(), {{t.x, ab, ca}, {t.y, bc, ab}, {t.z, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (glm::dvec3& position : mesh.positions) {
    position *= radius;
  }
  return mesh;
}

/// A torus about the y axis, 2 * around * across triangles.
inline SurfaceMesh torus_mesh(double ring_radius, double tube_radius, std::uint32_t around,
                              std::uint32_t across) {
  SurfaceMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double u = 2.0 * std::numbers::pi * i / around;
    for (std::uint32_t j = 0; j < across; ++j) {
      const double v = 2.0 * std::numbers::pi * j / across;
      const double rho = ring_radius + tube_radius * std::cos(v);
      mesh.positions.emplace_back(rho * std::cos(u), tube_radius * std::sin(v), rho * std::sin(u));
      const std::uint32_t i1 = (i + 1) % around;
      const std::uint32_t j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j;
      const std::uint32_t b = i1 * across + j;
      const std::uint32_t c = i1 * across + j1;
      const std::uint32_t d = i * across + j1;
      mesh.triangles.emplace_back(a, c, b);
      mesh.triangles.emplace_back(a, d, c);
    }
  }
  return mesh;
}

/// Signed distance to that torus' exact surface.
inline double torus_distance(double ring_radius, double tube_radius, const glm::dvec3& p) {
  return std::hypot(std::hypot(p.x, p.z) - ring_radius, p.y) - tube_radius;
}

/// A prism along z, from -half_depth to half_depth, over the polygon `outline` in x and y,
/// counter-clockwise and star-shaped about its first corner.
inline SurfaceMesh prism_mesh(const std::vector<glm::dvec2>& outline, double half_depth) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {-half_depth, half_depth}) {
    for (const glm::dvec2& corner : outline) {
      mesh.positions.emplace_back(corner.x, corner.y, z);
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.emplace_back(i, j, n + j);
    mesh.triangles.emplace_back(i, n + j, n + i);
    if (i > 0 && j > 0) {
      mesh.triangles.emplace_back(0, j, i);
      mesh.triangles.emplace_back(n, n + i, n + j);
    }
  }
  return mesh;
}

inline SurfaceMesh box_mesh(const glm::dvec3& half) {
  return prism_mesh({{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}},
                    half.z);
}

/// An L whose inner edge is the z axis: the square [-size, size]^2 without its quarter x, y > 0.
inline SurfaceMesh l_shape_mesh(double size, double half_depth) {
  return prism_mesh(
      {{0.0, 0.0}, {0.0, size}, {-size, size}, {-size, -size}, {size, -size}, {size, 0.0}},
      half_depth);
}

}  // namespace torsion::engine
