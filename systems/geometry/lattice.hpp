#pragma once

// How finely a box is cut into cells of equal sides.

#include <algorithm>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion {

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

}  // namespace torsion
