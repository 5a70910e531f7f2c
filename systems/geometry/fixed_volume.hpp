#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "ecs/components.hpp"

namespace torsion {

/// Whether a point of the body's frame lies in a volume that fixes the body, or on its surface.
inline bool in_volume(const FixedVolume& volume, const glm::dvec3& point) {
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  return volume.kind == VolumeKind::kSphere
             ? glm::length(unit) <= 1.0
             : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0;
}

}  // namespace torsion
