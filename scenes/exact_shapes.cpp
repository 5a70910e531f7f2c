#include "scenes/exact_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace torsion::engine {
namespace {

constexpr double kSameWithin = 0.01;  // relative difference of extents that count as equal

bool same(double a, double b) {
  return std::abs(a - b) <= kSameWithin * std::max(a, b);
}

std::string extents_text(const glm::dvec3& half) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.6g x %.6g x %.6g m", 2.0 * half.x, 2.0 * half.y,
                2.0 * half.z);
  return text.data();
}

/// A point of the surface of the cube of side 2, moved to the shape's.
glm::dvec3 onto(const ShapePart& shape, const glm::dvec3& point) {
  const glm::dvec3& half = shape.half_extent;
  const glm::dvec3 direction = glm::normalize(point);
  const double square = std::max(std::abs(point.x), std::abs(point.z));
  const double flat = std::hypot(point.x, point.z);
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return half.x * direction;
    case ShapeKind::kEllipsoid:
      return half * direction;
    case ShapeKind::kCylinder: {
      const double in = flat > 0.0 ? half.x * square / flat : 0.0;
      return {in * point.x, half.y * point.y, in * point.z};
    }
    case ShapeKind::kCapsule: {
      // The middle half of the cube's sides becomes the mantle, the rest the caps.
      const double up = std::copysign(std::max(0.0, 2.0 * std::abs(point.y) - 1.0), point.y);
      const double along = std::clamp(2.0 * point.y, -1.0, 1.0);
      return half.x * glm::normalize(glm::dvec3(point.x, up, point.z)) +
             glm::dvec3(0.0, (half.y - half.x) * along, 0.0);
    }
    default:
      return half * point;
  }
}

}  // namespace

ShapeKind shape_kind(const std::string& name) {
  const std::map<std::string, ShapeKind> kinds = {
      {"mesh", ShapeKind::kMesh},         {"box", ShapeKind::kBox},
      {"sphere", ShapeKind::kSphere},     {"ellipsoid", ShapeKind::kEllipsoid},
      {"cylinder", ShapeKind::kCylinder}, {"capsule", ShapeKind::kCapsule}};
  return kinds.at(name);
}

std::optional<ShapePart> fit_shape(ShapeKind kind, const glm::dvec3& lowest,
                                   const glm::dvec3& highest, const NodeTransform& to_owner,
                                   const std::string& where, const ProblemList& problems) {
  ShapePart shape;
  shape.kind = kind;
  shape.half_extent = 0.5 * glm::abs(to_owner.scale) * (highest - lowest);
  shape.pose.rotation = to_owner.rotation;
  shape.pose.position =
      to_owner.translation + to_owner.rotation * (to_owner.scale * (0.5 * (lowest + highest)));
  const glm::dvec3& half = shape.half_extent;
  const auto refuse = [&](const std::string& expected, const std::string& mend) {
    problems.add(where, "torsion_shape", extents_text(half) + " along x, y, z", expected, mend);
    return std::nullopt;
  };
  if (!(std::min({half.x, half.y, half.z}) > 1e-6)) {
    return refuse("expected an extent along each axis", "give the mesh a thickness");
  }
  const bool round = same(half.x, half.z);
  if (kind == ShapeKind::kSphere && !(round && same(half.x, half.y))) {
    return refuse("expected equal extents for a sphere", "use ellipsoid");
  }
  if (kind == ShapeKind::kCylinder && !round) {
    return refuse("expected equal extents along x and z for a cylinder",
                  "its axis is the node's y axis in the glTF (Blender's z): turn the mesh");
  }
  if (kind == ShapeKind::kCapsule && !(round && half.y >= half.x * (1.0 - kSameWithin))) {
    return refuse("expected equal extents along x and z, and no less along y, for a capsule",
                  "its axis is the node's y axis in the glTF (Blender's z): turn the mesh");
  }
  return shape;
}

SurfaceMesh tessellate(const ShapePart& shape, int fineness) {
  SurfaceMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> rows;
  const auto vertex = [&](const std::array<int, 3>& key) {
    const auto [entry, fresh] =
        rows.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      const glm::dvec3 point =
          2.0 * glm::dvec3(key[0], key[1], key[2]) / static_cast<double>(fineness) - 1.0;
      mesh.positions.push_back(shape.pose.rotation * onto(shape, point) + shape.pose.position);
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, fineness}) {
      for (int i = 0; i < fineness; ++i) {
        for (int j = 0; j < fineness; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> key{};
            key[axis] = side;
            key[(axis + 1) % 3] = i + a;
            key[(axis + 2) % 3] = j + b;
            return vertex(key);
          };
          const std::array<std::uint32_t, 4> quad = {corner(0, 0), corner(1, 0), corner(1, 1),
                                                     corner(0, 1)};
          if (side == 0) {
            mesh.triangles.emplace_back(quad[0], quad[2], quad[1]);
            mesh.triangles.emplace_back(quad[0], quad[3], quad[2]);
          } else {
            mesh.triangles.emplace_back(quad[0], quad[1], quad[2]);
            mesh.triangles.emplace_back(quad[0], quad[2], quad[3]);
          }
        }
      }
    }
  }
  return mesh;
}

MeshTriangles drawn_mesh(const SurfaceMesh& surface) {
  constexpr double kCrease = 0.766;  // cosine of 40 degrees
  std::vector<glm::dvec3> faces;     // area vectors
  std::vector<std::vector<std::uint32_t>> faces_at(surface.positions.size());
  for (const glm::uvec3& corners : surface.triangles) {
    const glm::dvec3& a = surface.positions[corners.x];
    faces.push_back(glm::cross(surface.positions[corners.y] - a, surface.positions[corners.z] - a));
    for (int corner = 0; corner < 3; ++corner) {
      faces_at[corners[corner]].push_back(static_cast<std::uint32_t>(faces.size() - 1));
    }
  }
  MeshTriangles mesh;
  // (vertices of the surface) those of the mesh that are made of it
  std::vector<std::vector<std::uint32_t>> made(surface.positions.size());
  const auto vertex = [&](std::uint32_t at, const glm::dvec3& face) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t other : faces_at[at]) {
      const double cosine = glm::dot(glm::normalize(faces[other]), glm::normalize(face));
      sum += cosine > kCrease ? faces[other] : glm::dvec3(0.0);
    }
    const glm::dvec3 normal = glm::normalize(sum);
    for (const std::uint32_t row : made[at]) {
      if (glm::dot(mesh.normals[row], normal) > 1.0 - 1e-9) {
        return row;
      }
    }
    made[at].push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(surface.positions[at]);
    mesh.normals.push_back(normal);
    return made[at].back();
  };
  for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
    const glm::uvec3& corners = surface.triangles[triangle];
    const glm::dvec3& face = faces[triangle];
    mesh.triangles.emplace_back(vertex(corners.x, face), vertex(corners.y, face),
                                vertex(corners.z, face));
  }
  return mesh;
}

}  // namespace torsion::engine
