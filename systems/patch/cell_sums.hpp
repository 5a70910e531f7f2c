#pragma once

// What a region with contact model `patch` is as a whole: sums over its cells.

#include <glm/vec2.hpp>

#include "systems/math/wide_lanes.hpp"
#include "systems/patch/cells.hpp"

namespace torsion::engine {

/// How far a cell slips along its friction, times that, beyond what rounding leaves: while nothing
/// moves, the sign of what the equations lack is random.
/// @param left_x  m: target less displacement
/// @param slide   out
template <class Number>
TORSION_LANES void slide_beyond_rounding(const Number& traction_x, const Number& traction_y,
                                         const Number& left_x, const Number& left_y,
                                         const Number& moved_x, const Number& moved_y,
                                         Number& slide) {
  constexpr double kSlipRounding = 1e-9;
  const Number work = traction_x * moved_x + traction_y * moved_y;
  slide =
      traction_x * left_x + traction_y * left_y - kSlipRounding * choose(work < 0.0, -work, work);
}

/// Sums over the cells, in the grid's frame. What is weighted with the pressure is zero without.
struct PatchSums {
  double force = 0.0;         // N
  glm::dvec2 center{0.0};     // m: of the pressure
  double height = 0.0;        // m: the tool's, weighted with the pressure
  double depth = 0.0;         // m: likewise
  glm::dvec2 moved{0.0};      // m: displacement, likewise
  double turn = 0.0;          // rad: of the surface about `center`, likewise
  glm::dvec2 friction{0.0};   // N, on the tool
  double couple = 0.0;        // N m about the grid's origin
  double loaded_cells = 0.0;  // with the share of each that is in contact
  // m: theirs, those of small pressure less, so that it does not jump as they come and go
  glm::dvec2 middle{0.0};
  double stuck_cells = 0.0;
};

/// @param cell_area  m^2
/// @param reference  Pa: typical pressure
PatchSums sum_cells(const PatchColumns& columns, const PatchPlaces& places, double cell_area,
                    double reference);

/// The mean of the pressures that there are, Pa; 0 without.
double mean_pressure(const PatchColumns& columns);

}  // namespace torsion::engine
