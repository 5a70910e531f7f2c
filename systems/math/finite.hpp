#pragma once

#include <cmath>

#include "ecs/components.hpp"

namespace torsion::engine {

/// True where no number of the wrench is infinite or not a number.
inline bool finite(const Wrench& wrench) {
  const glm::dvec3 sum = wrench.force + wrench.torque;
  return std::isfinite(sum.x + sum.y + sum.z);
}

/// True for a pose whose numbers are finite and whose quaternion has a length near 1.
inline bool usable(const Pose& pose) {
  const glm::dvec3& p = pose.position;
  const glm::dquat& q = pose.rotation;
  return std::isfinite(p.x + p.y + p.z) &&
         std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 0.01;
}

}  // namespace torsion::engine
