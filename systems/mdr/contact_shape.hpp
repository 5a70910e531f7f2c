#pragma once

// The paraboloid that fits a region's overlap.

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "ecs/components.hpp"

namespace torsion {

struct ContactShape {
  double depth = 0.0;        // m: at the apex, over the centre where flat
  glm::dvec2 apex{0.0};      // m, grid: of the paraboloid, the middle where flat
  double curvature_1 = 0.0;  // 1/m, principal, >= 0: how fast the depth falls away from the apex
  double curvature_2 = 0.0;  // 1/m
  // m, along the same axes: half of the overlap's length, of a rectangle 1.15 times that (twice the
  // spread of the area, so that a square is about as wide as the disc of its area).
  double extent_1 = 0.0;
  double extent_2 = 0.0;
};

/// Least squares over the cells in contact, weighted by their share in it and about the square of
/// their depth, for what lies near the apex matters most. In a direction in which the depth hardly
/// falls off, because the contact is flat and ends at an edge, no apex can be told: there the place
/// is that of a stamp's force, and the depth is that over the middle of the area, which a tilt
/// about it does not change.
/// @param cells  (side x side)
ContactShape fit_contact_shape(const RegionFrame& frame, std::uint32_t side,
                               std::span<const CellGeometry> cells);

}  // namespace torsion
