#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace torsion {

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

/// Rotation vector from `from` to `to`, rad, the short way round; outer axes.
inline glm::dvec3 turn_between(const glm::dquat& from, const glm::dquat& to) {
  return rotation_vector(to * glm::conjugate(from));
}

}  // namespace torsion
