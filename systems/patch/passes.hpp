#pragma once

// The loops over cells of the contact model `patch`, free of branches and compiled for the widest
// vectors there are. Where nothing else is said, every column is `count` long, a multiple of
// kLanes; rows beyond the cells are zero, and stay so.

#include <cstddef>
#include <cstdint>

#include "systems/half_space/influence.hpp"
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
/// @param wanted  as above, followed by kLanes zeros
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

// The loops of patch/passes.hpp over the tangential tractions.

/// All cells of a grid. Those that can carry no load have no limit: they slip, and stay without
/// traction.
struct TractionColumns {
  std::size_t count = 0;
  const double *pressure, *friction;
  double *traction_x, *traction_y;    // Pa
  const double *target_x, *target_y;  // m
  double *moved_x, *moved_y;          // m
  double* slips;                      // 1 or 0
  double* limit;                      // Pa: of the friction
  double *residual_x, *residual_y;    // m: what a cell asks to be moved by
  double *asked_x, *asked_y;          // Pa
  double *along_x, *along_y;          // unit: of the friction of a cell that slips
  double* softened;                   // of what turns it: 1 where nothing slips
  double *step_x, *step_y;            // Pa: the last change
  double* clips;                      // 1 where a step is cut off at the disc's rim, else 0
  const double *moves_x, *moves_y;    // m: what it displaces
};

/// @return true when a traction lies outside its disc
bool find_limits(const TractionColumns& cells);

/// What is left of every cell's way. Where a cell is at its limit, only the part across its
/// friction turns it. That part is held back by the slip that there is, |s| / (mu p), on top of the
/// cell's own compliance: the curvature of the disc (Newton's method on the disc's rim).
/// @param stiffness  Pa/m, of a cell on its own
void find_ways(const TractionColumns& cells, double stiffness);

/// Of displacements or tractions what the cells answer: all of it, or what is across their
/// friction.
void keep_answered(const TractionColumns& cells, double* x, double* y);

/// Shares of what is asked and of the last step.
struct Mix {
  double asked = 1.0;
  double kept = 0.0;
};

/// What a step would do.
struct TractionStep {
  double slope = 0.0;    // Pa m: of the energy, downhill
  double slips = 0.0;    // cells with a load that end on their discs' rims
  double clipped = 0.0;  // of those the ones that have stuck
};

/// Turns what is asked and kept into a step that ends within the discs.
TractionStep mix_tractions(const TractionColumns& cells, const Mix& mix);

/// Of the energy along a change of the tractions, downhill, Pa m.
double slope_along(const TractionColumns& cells, const double* x, const double* y);

/// Goes `length` of the step, which becomes the change.
SweepChange change_tractions(const TractionColumns& cells, double length);

/// Sums of squares over the cells, m^2.
struct TractionResidual {
  double lacking = 0.0;  // of the displacement by which a cell's traction q is not q = P(q + k s)
  double scale = 0.0;    // of friction's coefficient times depth, where there is pressure
};

/// What is left of the equations of friction: with s = target - moved, any k > 0 and P onto the
/// disc of radius mu p they are q = P(q + k s). (Alart and Curnier, Computer Methods in Applied
/// Mechanics and Engineering 92 (1991) 353)
/// @param stiffness  k, Pa/m
TractionResidual traction_residual(const TractionColumns& cells, const double* depth,
                                   double stiffness);

/// Cells at their limit whose way left to go leads against their friction do not slip: to let them
/// go there would give work. What is left is yet to be done.
void keep_what_is_no_slip(const TractionColumns& cells);

}  // namespace torsion
