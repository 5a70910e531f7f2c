#include "app/report/shapes.hpp"

#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

/// The surface of the cube from -1 to 1, welded.
SurfaceMesh cube_surface(std::uint32_t cuts) {
  SurfaceMesh mesh;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> rows;
  const auto vertex = [&](std::size_t axis, std::uint32_t side, std::uint32_t i, std::uint32_t j) {
    std::array<std::uint32_t, 3> place{};
    place[axis] = side;
    place[(axis + 1) % 3] = i;
    place[(axis + 2) % 3] = j;
    const auto [entry, fresh] =
        rows.try_emplace(place, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      const glm::dvec3 whole(place[0], place[1], place[2]);
      mesh.positions.push_back(whole * (2.0 / cuts) - glm::dvec3(1.0));
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::uint32_t side : {0U, cuts}) {
      for (std::uint32_t i = 0; i < cuts; ++i) {
        for (std::uint32_t j = 0; j < cuts; ++j) {
          const std::uint32_t a = vertex(axis, side, i, j);
          const std::uint32_t b = vertex(axis, side, i + 1, j);
          const std::uint32_t c = vertex(axis, side, i + 1, j + 1);
          const std::uint32_t d = vertex(axis, side, i, j + 1);
          // a, b, c, d turn about +axis: outward on the far side, inward on the near one.
          mesh.triangles.push_back(side == 0 ? glm::uvec3(a, c, b) : glm::uvec3(a, b, c));
          mesh.triangles.push_back(side == 0 ? glm::uvec3(a, d, c) : glm::uvec3(a, c, d));
        }
      }
    }
  }
  return mesh;
}

glm::dvec3 onto_shape(ShapeKind kind, const glm::dvec3& half, const glm::dvec3& cube) {
  const glm::dvec3 unit = glm::normalize(cube);
  switch (kind) {
    case ShapeKind::kSphere:
      return half.x * unit;
    case ShapeKind::kEllipsoid:
      return half * unit;
    case ShapeKind::kCapsule:
      return half.x * unit + glm::dvec3(0.0, std::copysign(half.y - half.x, unit.y), 0.0);
    case ShapeKind::kCylinder: {
      const glm::dvec2 flat(cube.x, cube.z);
      const double square = std::max(std::abs(cube.x), std::abs(cube.z));
      const glm::dvec2 round = square > 0.0 ? flat * (square / glm::length(flat)) : glm::dvec2(0.0);
      return {half.x * round.x, half.y * cube.y, half.x * round.y};
    }
    case ShapeKind::kBox:
    case ShapeKind::kMesh:
      break;
  }
  return half * cube;
}

}  // namespace

SurfaceMesh shape_surface(ShapeKind kind, const glm::dvec3& half_extent, std::uint32_t cuts) {
  SurfaceMesh mesh = cube_surface(cuts);
  for (glm::dvec3& position : mesh.positions) {
    position = onto_shape(kind, half_extent, position);
  }
  return mesh;
}

PartDescription exact_part(ShapeKind kind, const glm::dvec3& half_extent, const Pose& pose,
                           std::uint32_t cuts) {
  PartDescription part;
  part.node = "part";
  part.shape.kind = kind;
  part.shape.half_extent = half_extent;
  part.shape.pose = pose;
  part.surface = shape_surface(kind, half_extent, cuts);
  for (glm::dvec3& position : part.surface.positions) {
    position = to_outer(pose, position);
  }
  return part;
}

DrawMesh drawn(const std::vector<SurfaceMesh>& surfaces, bool smooth, const glm::vec4& color) {
  DrawMesh mesh;
  mesh.materials.front().color = color;
  for (const SurfaceMesh& surface : surfaces) {
    std::vector<glm::dvec3> corner_normals(surface.positions.size(), glm::dvec3(0.0));
    std::vector<glm::dvec3> face_normals;
    for (const glm::uvec3& t : surface.triangles) {
      const glm::dvec3& a = surface.positions[t.x];
      const glm::dvec3 normal = glm::cross(surface.positions[t.y] - a, surface.positions[t.z] - a);
      face_normals.push_back(glm::normalize(normal));
      for (const std::uint32_t corner : {t.x, t.y, t.z}) {
        corner_normals[corner] += normal;
      }
    }
    for (std::size_t face = 0; face < surface.triangles.size(); ++face) {
      const glm::uvec3& t = surface.triangles[face];
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const std::uint32_t corner : {t.x, t.y, t.z}) {
        mesh.positions.emplace_back(surface.positions[corner]);
        mesh.normals.emplace_back(smooth ? glm::normalize(corner_normals[corner])
                                         : face_normals[face]);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
  }
  return mesh;
}

}  // namespace torsion::engine
