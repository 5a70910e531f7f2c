#pragma once

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "ecs/components.hpp"

namespace torsion::engine {

/// True where no number of the wrench is infinite or not a number.
inline bool finite(const Wrench& wrench) {
  const glm::dvec3 sum = wrench.force + wrench.torque;
  return std::isfinite(sum.x + sum.y + sum.z);
}

/// True where the pose's numbers are finite and its quaternion is one that can be made a unit.
inline bool finite(const Pose& pose) {
  const glm::dquat& q = pose.rotation;
  const double norm = glm::dot(q, q);
  return std::isfinite(pose.position.x + pose.position.y + pose.position.z) &&
         std::isfinite(norm) && norm > 0.25 && norm < 4.0;
}

}  // namespace torsion::engine
