#include "device/composite.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "ecs/assert.hpp"

namespace torsion::engine {
namespace {

constexpr double kSame = 1e-9;  // m: points nearer than this have no line between them

using Points = std::array<glm::dvec3, kMostPoints>;

glm::dvec3 mean_of(std::span<const glm::dvec3> points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& point : points) {
    sum += point;
  }
  return sum / static_cast<double>(points.size());
}

/// The shortest turn from one direction to another.
glm::dquat shortest_turn(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 a = glm::normalize(from);
  const glm::dvec3 b = glm::normalize(to);
  const glm::dvec3 axis = glm::cross(a, b);
  const double w = 1.0 + glm::dot(a, b);
  if (w < 1e-12) {  // opposite: any axis across
    const glm::dvec3 across =
        std::abs(a.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 n = glm::normalize(glm::cross(a, across));
    return {0.0, n.x, n.y, n.z};
  }
  return glm::normalize(glm::dquat(w, axis.x, axis.y, axis.z));
}

/// Axes of a triangle: along its first side, across it in its plane, off the plane.
glm::dmat3 triangle_axes(std::span<const glm::dvec3> points) {
  const glm::dvec3 along = glm::normalize(points[1] - points[0]);
  const glm::dvec3 off = glm::normalize(glm::cross(along, points[2] - points[0]));
  return {along, glm::cross(off, along), off};
}

}  // namespace

CarriedTool carried_at(std::size_t count, double spacing) {
  TORSION_ASSERT(count == 2 || count == 3);
  CarriedTool tool;
  tool.count = count;
  if (count == 2) {
    tool.points[0] = {-0.5 * spacing, 0.0, 0.0};
    tool.points[1] = {0.5 * spacing, 0.0, 0.0};
    return tool;
  }
  const double radius = spacing / std::numbers::sqrt3;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) / 3.0 + 0.25);
    tool.points[i] = {radius * std::cos(angle), 0.0, -radius * std::sin(angle)};
  }
  return tool;
}

Pose carried_pose(const CarriedTool& tool, std::span<const glm::dvec3> places) {
  Points now{};
  for (std::size_t i = 0; i < tool.count; ++i) {
    now[i] = tool.points[i] + places[i];
  }
  const auto rest = std::span(tool.points).first(tool.count);
  const auto moved = std::span<const glm::dvec3>(now).first(tool.count);
  Pose pose;
  if (glm::length(now[1] - now[0]) > kSame) {
    if (tool.count == 2) {
      pose.rotation = shortest_turn(rest[1] - rest[0], moved[1] - moved[0]);
    } else if (glm::length(glm::cross(now[1] - now[0], now[2] - now[0])) > kSame * kSame) {
      pose.rotation = glm::normalize(
          glm::quat_cast(triangle_axes(moved) * glm::transpose(triangle_axes(rest))));
    }
  }
  pose.position = mean_of(moved) - pose.rotation * mean_of(rest);
  return pose;
}

void carried_forces(const CarriedTool& tool, std::span<const glm::dvec3> places,
                    const Wrench& wrench, std::span<glm::dvec3> forces) {
  Points now{};
  for (std::size_t i = 0; i < tool.count; ++i) {
    now[i] = tool.points[i] + places[i];
  }
  const auto moved = std::span<const glm::dvec3>(now).first(tool.count);
  const glm::dvec3 middle = mean_of(moved);
  // The least forces have the form f / n + w x r about the middle (the multipliers of the two
  // conditions), with J w = torque, J = sum |r|^2 I - r r^T.
  const glm::dvec3 origin = carried_pose(tool, places).position;
  const glm::dvec3 torque = wrench.torque + glm::cross(origin - middle, wrench.force);
  glm::dvec3 w(0.0);
  if (tool.count == 2) {
    const glm::dvec3 r = moved[1] - middle;
    const double square = glm::dot(r, r);
    if (square > kSame * kSame) {
      w = (torque - r * (glm::dot(torque, r) / square)) / (2.0 * square);
    }
  } else {
    glm::dmat3 inertia(0.0);
    for (const glm::dvec3& point : moved) {
      const glm::dvec3 r = point - middle;
      inertia += glm::dmat3(glm::dot(r, r)) - glm::outerProduct(r, r);
    }
    if (std::abs(glm::determinant(inertia)) > 1e-18) {
      w = glm::inverse(inertia) * torque;
    }
  }
  for (std::size_t i = 0; i < tool.count; ++i) {
    forces[i] = wrench.force / static_cast<double>(tool.count) + glm::cross(w, moved[i] - middle);
  }
}

}  // namespace torsion::engine
