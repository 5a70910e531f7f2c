#pragma once

// The loops over cells of the contact model `patch`, free of branches and compiled for the widest
// vectors there are. Where nothing else is said, every column is `count` long, a multiple of
// kPatchLanes; rows beyond the cells are zero, and stay so.

#include <cstddef>
#include <cstdint>

#include "systems/half_space/local_inverse.hpp"
#include "systems/math/wide_lanes.hpp"

namespace torsion {

/// How much a sweep changes, Pa.
struct SweepChange {
  double largest = 0.0;
  double sum = 0.0;  // over the cells, both components
};

/// Sum of products.
double dot(std::size_t count, const double* a, const double* b);

/// Of two columns each.
double dot(std::size_t count, const double* a_x, const double* a_y, const double* b_x,
           const double* b_y);

/// The largest of the values and 0.
double largest(std::size_t count, const double* values);

/// to += scale * values; of any length.
void add_scaled(std::size_t count, double scale, const double* values, double* to);

/// product = a times b, each; may be one of them.
void multiply(std::size_t count, const double* a, const double* b, double* product);

/// Cells (side x side) into the middle of ((side + 2) x (side + 2)).
void to_border(std::uint32_t side, const double* cells, double* bordered);

/// asked = inverse times scale times wanted.
/// @param wanted  ((side + 2) x (side + 2)), with a border of zeros
/// @param asked   (side x side) out
void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* wanted, double* asked);

/// Sum of what is wanted times what the inverse, times scale, asks for it.
/// @param wanted  as above, followed by kPatchLanes zeros
double wanted_by_asked(const LocalInverse& inverse, double scale, std::uint32_t side,
                       const double* wanted);

// pressures ---------------------------------------------------------------------------------------

/// The gap that is left to close, m: where there is pressure, and where the surfaces overlap.
void find_overlaps(std::size_t count, const double* depth, const double* depression,
                   const double* pressure, double* residual);

/// Sums of squares over the cells, m^2.
struct PressureResidual {
  double lacking = 0.0;  // of the gap or overlap under pressure, and of overlap without
  double scale = 0.0;    // of the depth
};
PressureResidual pressure_residual(std::size_t count, const double* depth, const double* depression,
                                   const double* pressure);

/// asked = 0 where there is no residual.
/// @return the sum of the residual's squares under the preconditioner
double keep_asked(std::size_t count, const double* residual, double* asked);

/// step = what is asked, and `kept` of the last step.
/// @return the slope of the energy along it, downhill, Pa m
double mix_pressures(std::size_t count, const double* residual, const double* asked, double kept,
                     double* step);

/// Goes `length` of the step, which becomes the change.
/// @param pull  the largest that there is then, Pa
SweepChange change_pressures(std::size_t count, double length, const double* moves, double* step,
                             double* pressure, double* depression, double& pull);

/// step = what takes away the pull.
void find_pulls(std::size_t count, const double* pressure, double* step);

/// Takes pressure and tractions away where the pressure is not positive or the depth not over the
/// least.
/// @param change_pressure, change_x, change_y  Pa, out
/// @return whether there was any
bool lose_cells(std::size_t count, double least_depth, const double* depth, double* pressure,
                double* traction_x, double* traction_y, double* change_pressure, double* change_x,
                double* change_y);

}  // namespace torsion
