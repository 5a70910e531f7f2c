#pragma once

#include <cmath>

#include "ecs/components.hpp"

namespace torsion::engine {

/// True where no number of the wrench is infinite or not a number.
inline bool finite(const Wrench& wrench) {
  const glm::dvec3 sum = wrench.force + wrench.torque;
  return std::isfinite(sum.x + sum.y + sum.z);
}

}  // namespace torsion::engine
