#pragma once

// The paraboloid that fits a region's overlap.

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "ecs/components.hpp"

namespace torsion {

struct ContactShape {
  double depth = 0.0;        // m, at the apex
  glm::dvec2 apex{0.0};      // m, grid
  double curvature_1 = 0.0;  // 1/m, principal, >= 0: how fast the depth falls away from the apex
  double curvature_2 = 0.0;  // 1/m
};

/// Least squares over the cells in contact, weighted by the square of their depth, for what lies
/// near the apex matters most. Where a direction is flat or hollow its curvature is zero and the
/// apex is over the middle of the cells.
/// @param cells  (side x side)
ContactShape fit_contact_shape(const RegionFrame& frame, std::uint32_t side,
                               std::span<const CellGeometry> cells);

}  // namespace torsion
