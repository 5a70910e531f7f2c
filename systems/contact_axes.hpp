#pragma once

#include <cmath>
#include <span>

#include "systems/grid_cells.hpp"

namespace torsion {

/// Of the allowance of a contact's axes: to turn a grid by less changes nothing.
inline constexpr double kAligned = 0.05;

/// How a contact lies in its grid.
struct ContactAxes {
  double angle = 0.0;      // rad: by which the grid is to be turned about its normal so that one of
                           // its axes lies along the contact; 0 for one that is not long
  double allowance = 0.0;  // rad: how far it may be off before that is worth it
  // m, along the grid's axes: of the rectangle that has the same middle and second moments
  glm::dvec2 middle{0.0};
  glm::dvec2 size{0.0};

  [[nodiscard]] bool is_long() const { return allowance > 0.0; }
  [[nodiscard]] bool is_askew() const { return std::abs(angle) > allowance; }
};

/// By the second moments of what `weights` (side x side) count of each cell. The grid's longer axis
/// goes along the contact, in a square one the nearer.
ContactAxes contact_axes(const Grid& grid, std::span<const double> weights);

/// Turns the grid's tangents about its normal.
void turn_axes(RegionFrame& frame, double angle);

}  // namespace torsion
