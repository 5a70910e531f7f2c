#pragma once

// Boxes along the axes around places.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"
#include "ecs/components/bodies.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// The least box around places, m; of none it is inside out.
Bounds bounds_of(std::span<const glm::dvec3> places);

/// The least box around the surfaces of parts, in their owner's frame.
Bounds bounds_of(std::span<const PartDescription> parts);

/// True where two boxes have a place in common, or are no farther apart than `slack`, m, along each
/// axis.
bool boxes_meet(const Bounds& a, const Bounds& b, double slack);

/// Whether a point of the body's frame lies in a volume that fixes the body, or on its surface.
inline bool in_volume(const FixedVolume& volume, const glm::dvec3& point) {
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  return volume.kind == VolumeKind::kSphere
             ? glm::length(unit) <= 1.0
             : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0;
}

// How finely a box is cut into cells of equal sides.

/// A lattice has at least as many cells as this along each side: a bend needs some.
inline constexpr std::uint32_t kFewestLatticeCells = 8;

/// All cells of the lattice over a box.
/// @param along  cells along the longest side
inline double lattice_cells(const glm::dvec3& extent, std::uint32_t along) {
  const double longest = std::max({extent.x, extent.y, extent.z});
  const glm::dvec3 cells = glm::max(extent * (along / longest), glm::dvec3(kFewestLatticeCells));
  return cells.x * cells.y * cells.z;
}

/// Cells along the longest side of the lattice by which a body's compliance is found: as many as a
/// cube of 16 has in all, and at least 16. Bodies with thin walls get more.
inline std::uint32_t compliance_elements(const Bounds& bounds) {
  constexpr double kInAll = 4500.0;
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  std::uint32_t elements = 16;
  while (elements < 40 && lattice_cells(extent, elements + 1) <= kInAll) {
    ++elements;
  }
  return elements;
}

}  // namespace torsion::engine
