#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion::engine {

/// The cross product of two vectors of a plane: the signed area of the parallelogram they span.
inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Rotation vector of a unit quaternion, rad, the short way round, |vector| <= pi.
inline glm::dvec3 rotation_vector(glm::dquat q) {
  if (q.w < 0.0) {
    q = -q;
  }
  const glm::dvec3 imaginary(q.x, q.y, q.z);
  const double sine = glm::length(imaginary);
  if (sine < 1e-12) {
    return 2.0 * imaginary;
  }
  return imaginary * (2.0 * std::atan2(sine, q.w) / sine);
}

/// The rotation of a rotation vector, rad.
inline glm::dquat rotation_by(const glm::dvec3& vector) {
  const double angle = glm::length(vector);
  return angle > 0.0 ? glm::angleAxis(angle, vector / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

/// Rotation vector from `from` to `to`, rad, the short way round; outer axes.
inline glm::dvec3 turn_between(const glm::dquat& from, const glm::dquat& to) {
  return rotation_vector(to * glm::conjugate(from));
}

/// x_outer of a point given in the frame of `pose`.
inline glm::dvec3 to_outer(const Pose& pose, const glm::dvec3& point) {
  return pose.rotation * point + pose.position;
}

/// x_inner of a point given in the frame in which `pose` is expressed.
inline glm::dvec3 to_inner(const Pose& pose, const glm::dvec3& point) {
  return glm::conjugate(pose.rotation) * (point - pose.position);
}

/// The pose of `inner` seen from `outer`, both given in one common frame.
inline Pose relative(const Pose& outer, const Pose& inner) {
  return {to_inner(outer, inner.position), glm::conjugate(outer.rotation) * inner.rotation};
}

/// Grid (x, y, z) to body.
inline glm::dvec3 grid_to_body(const RegionFrame& frame, const glm::dvec3& point) {
  return frame.origin + frame.tangent_x * point.x + frame.tangent_y * point.y +
         frame.normal * point.z;
}

/// A direction of the grid's tangent plane in the body frame.
inline glm::dvec3 tangent_to_body(const RegionFrame& frame, const glm::dvec2& direction) {
  return frame.tangent_x * direction.x + frame.tangent_y * direction.y;
}

/// Components of a body-frame direction in the grid frame.
inline glm::dvec3 body_to_grid_direction(const RegionFrame& frame, const glm::dvec3& direction) {
  return {glm::dot(direction, frame.tangent_x), glm::dot(direction, frame.tangent_y),
          glm::dot(direction, frame.normal)};
}

inline glm::dvec3 body_to_grid(const RegionFrame& frame, const glm::dvec3& point) {
  return body_to_grid_direction(frame, point - frame.origin);
}

/// Turns the frame so that its normal is `normal` and its x axis turns as little as it can.
inline void turn_normal_to(RegionFrame& frame, const glm::dvec3& normal) {
  frame.normal = normal;
  const glm::dvec3 x = frame.tangent_x - normal * glm::dot(frame.tangent_x, normal);
  if (glm::dot(x, x) > 1e-6) {
    frame.tangent_x = glm::normalize(x);
  } else {
    frame.tangent_x = glm::normalize(frame.tangent_y - normal * glm::dot(frame.tangent_y, normal));
  }
  frame.tangent_y = glm::cross(normal, frame.tangent_x);
}

/// Centre of grid cell (i, j) of side x side cells, m, grid, z = 0.
inline glm::dvec2 cell_center(const RegionFrame& frame, std::uint32_t side, std::uint32_t i,
                              std::uint32_t j) {
  const double step = 2.0 / static_cast<double>(side);
  return {frame.half_size.x * ((static_cast<double>(i) + 0.5) * step - 1.0),
          frame.half_size.y * ((static_cast<double>(j) + 0.5) * step - 1.0)};
}

inline double cell_area(const RegionFrame& frame, std::uint32_t side) {
  return 4.0 * frame.half_size.x * frame.half_size.y / static_cast<double>(side * side);
}

}  // namespace torsion::engine
