#include "tests/support/contact_scenes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "systems/math/frames.hpp"
#include "tests/support/test_cache.hpp"

namespace torsion::engine::test {
namespace {

/// A box surface of n x n quads a face, welded, counter-clockwise from outside, with side 2 about
/// the origin.
SurfaceMesh cube_grid(std::uint32_t n) {
  SurfaceMesh mesh;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> rows;
  const auto vertex = [&](std::array<std::uint32_t, 3> key) {
    const auto [entry, fresh] =
        rows.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      mesh.positions.emplace_back(2.0 * key[0] / n - 1.0, 2.0 * key[1] / n - 1.0,
                                  2.0 * key[2] / n - 1.0);
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (const std::uint32_t side : {0U, n}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          const auto corner = [&](std::uint32_t a, std::uint32_t b) {
            std::array<std::uint32_t, 3> key{};
            key[axis] = side;
            key[u] = i + a;
            key[v] = j + b;
            return vertex(key);
          };
          const glm::uvec4 quad =
              side == 0 ? glm::uvec4(corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0))
                        : glm::uvec4(corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
          mesh.triangles.emplace_back(quad.x, quad.y, quad.z);
          mesh.triangles.emplace_back(quad.x, quad.z, quad.w);
        }
      }
    }
  }
  return mesh;
}

/// Puts a point of the cube's surface onto the shape's, along a straight or radial line.
glm::dvec3 onto_shape(ShapeKind kind, const glm::dvec3& half, const glm::dvec3& point) {
  const glm::dvec3 on_sphere = glm::normalize(point);
  const glm::dvec2 flat(point.x, point.z);
  const double square = std::max(std::abs(point.x), std::abs(point.z));
  const glm::dvec2 round = square > 0.0 ? flat * (square / glm::length(flat)) : flat;
  switch (kind) {
    case ShapeKind::kSphere:
      return half.x * on_sphere;
    case ShapeKind::kEllipsoid:
      return half * on_sphere;
    case ShapeKind::kCylinder:
      return {half.x * round.x, half.y * point.y, half.x * round.y};
    case ShapeKind::kCapsule:
      return half.x * on_sphere +
             glm::dvec3(0.0, std::copysign(half.y - half.x, point.y) * std::abs(point.y), 0.0);
    case ShapeKind::kBox:
    case ShapeKind::kMesh:
      break;
  }
  return half * point;
}

}  // namespace

SurfaceMesh tessellate(ShapeKind kind, const glm::dvec3& half_extent, std::uint32_t fineness) {
  SurfaceMesh mesh = cube_grid(2 * fineness);
  for (glm::dvec3& position : mesh.positions) {
    position = onto_shape(kind, half_extent, position);
  }
  return mesh;
}

PartDescription make_part(ShapeKind kind, const glm::dvec3& half_extent, const Pose& pose,
                          bool as_mesh, std::uint32_t fineness) {
  PartDescription part;
  part.node = "part";
  part.shape.kind = as_mesh ? ShapeKind::kMesh : kind;
  part.shape.half_extent = half_extent;
  part.shape.pose = pose;
  part.surface = tessellate(kind, half_extent, fineness);
  for (glm::dvec3& position : part.surface.positions) {
    position = to_outer(pose, position);
  }
  return part;
}

ToolDescription make_tool(std::vector<PartDescription> parts) {
  ToolDescription tool;
  tool.node = "tool";
  tool.parts = std::move(parts);
  return tool;
}

BodyDescription make_body(std::vector<PartDescription> parts) {
  BodyDescription body;
  body.node = "body";
  glm::dvec3 lowest(1e300);
  glm::dvec3 highest(-1e300);
  for (const PartDescription& part : parts) {
    for (const glm::dvec3& position : part.surface.positions) {
      lowest = glm::min(lowest, position);
      highest = glm::max(highest, position);
    }
  }
  body.fixed.point = {0.5 * (lowest.x + highest.x), lowest.y, 0.5 * (lowest.z + highest.z)};
  body.models = {ContactModel::kPaper, BodyModel::kSkeleton};
  body.parts = std::move(parts);
  return body;
}

SceneDescription ball_on_cube() {
  SceneDescription scene;
  scene.bodies.push_back(
      make_body({make_part(ShapeKind::kBox, glm::dvec3(0.05),
                           {glm::dvec3(0.0, 0.05, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)})}));
  scene.tools.push_back(make_tool({make_part(ShapeKind::kSphere, glm::dvec3(0.05))}));
  return scene;
}

Hand::Hand(const SceneDescription& scene, const PrepareOptions& options) {
  PrepareOptions here = options;
  here.use_cache = options.use_cache && has_test_cache();
  Result<Simulation> prepared = prepare(scene, here);
  if (!prepared) {
    throw std::runtime_error(prepared.error().text);
  }
  simulation_ = std::move(prepared).value();
  poses.resize(scene.tools.size());
}

void Hand::step_to(const std::vector<Pose>& next) {
  poses = next;
  torsion::engine::step(simulation_, poses);
}

void Hand::move(const glm::dvec3& shift, const glm::dvec3& turn_axis, double turn, int steps) {
  const std::vector<Pose> start = poses;
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    std::vector<Pose> next = start;
    next[0].position += shift * share;
    if (turn != 0.0) {
      next[0].rotation =
          glm::angleAxis(turn * share, glm::normalize(turn_axis)) * start[0].rotation;
    }
    step_to(next);
  }
}

}  // namespace torsion::engine::test
