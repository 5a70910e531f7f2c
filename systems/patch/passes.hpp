#pragma once

// The loops over cells of the contact model `patch`, free of branches and compiled for the widest
// vectors there are. Where nothing else is said, every column is `count` long, a multiple of
// kLanes; rows beyond the cells are zero, and stay so.

#include <cstddef>
#include <cstdint>

#include "systems/half_space/influence.hpp"
#include "systems/math/wide_lanes.hpp"

namespace torsion::engine {

/// How much an iteration changes, Pa.
struct IterationChange {
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

/// The preconditioner: preconditioned = scale times the local inverse times the residual.
/// @param residual        m, ((side + 2) x (side + 2)), with a border of zeros
/// @param preconditioned  Pa, (side x side) out
void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* residual, double* preconditioned);

/// u' B u with u the displacement and B scale times the local inverse, Pa m.
/// @param displacement  as the residual above, followed by kLanes zeros
double quadratic_form(const LocalInverse& inverse, double scale, std::uint32_t side,
                      const double* displacement);

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

/// z = 0 where there is no residual: those cells take no part.
/// @param preconditioned  z, Pa, in and out
/// @return r' z, Pa m
double mask_preconditioned(std::size_t count, const double* residual, double* preconditioned);

/// The search direction d = z + beta times the last step.
/// @return r' d, Pa m: the slope of the energy along it, downhill
double next_pressure_direction(std::size_t count, const double* residual,
                               const double* preconditioned, double beta, double* direction);

/// The step: pressure += alpha d, depression += alpha A d; d becomes alpha d.
/// @param response  A d, m
/// @param tension   out: the largest negative pressure that there is then, Pa
IterationChange step_pressures(std::size_t count, double alpha, const double* response,
                               double* direction, double* pressure, double* depression,
                               double& tension);

/// direction = what takes the tension away.
void find_tension(std::size_t count, const double* pressure, double* direction);

/// Takes pressure and tractions away where the pressure is not positive or the depth not over the
/// least.
/// @param change_pressure, change_x, change_y  Pa, out
/// @return whether there was any
bool release_unloaded(std::size_t count, double least_depth, const double* depth, double* pressure,
                      double* traction_x, double* traction_y, double* change_pressure,
                      double* change_x, double* change_y);

// tangential tractions ----------------------------------------------------------------------------

/// All cells of a grid. Those that can carry no load have no limit: they slip, and stay without
/// traction.
struct TractionColumns {
  std::size_t count = 0;
  const double *pressure, *friction;
  double *traction_x, *traction_y;              // Pa
  const double *target_x, *target_y;            // m
  double *moved_x, *moved_y;                    // m
  double* slips;                                // 1 or 0
  double* limit;                                // Pa: of the friction
  double *residual_x, *residual_y;              // m: r, by how much a cell is to be moved
  double *preconditioned_x, *preconditioned_y;  // Pa: z
  double *along_x, *along_y;                    // unit: of the friction of a cell that slips
  double* softened;                             // of what turns it: 1 where nothing slips
  double *direction_x, *direction_y;            // Pa: d; in between, the last step
  double* clips;                          // 1 where a step is cut off at the disc's rim, else 0
  const double *response_x, *response_y;  // m: A d
};

/// @return true when a traction lies outside its disc
bool find_limits(const TractionColumns& cells);

/// The residual: how far every cell is from its target. Of a cell at its limit only the part across
/// its friction counts, which turns it. That part is reduced by the slip, |s| / (mu p), on top of
/// the cell's own compliance: the curvature of the disc (Newton's method on the disc's rim).
/// @param stiffness  Pa/m, of a cell on its own
void find_residuals(const TractionColumns& cells, double stiffness);

/// Of displacements or tractions the part by which cells can change: all of it where they stick,
/// along the rim of the disc where they slip.
void project_on_tangents(const TractionColumns& cells, double* x, double* y);

/// A search direction is share times z, and beta times the last step.
struct DirectionShares {
  double share = 1.0;
  double beta = 0.0;
};

/// What a whole step along the search direction would do.
struct TractionStep {
  double slope = 0.0;    // Pa m: r' d, of the energy, downhill
  double slips = 0.0;    // cells with a load that end on their discs' rims
  double clipped = 0.0;  // of those the ones that have stuck
};

/// The search direction, cut so that a whole step ends within the discs.
TractionStep next_traction_direction(const TractionColumns& cells, const DirectionShares& shares);

/// Of the energy along a change of the tractions, downhill, Pa m.
double slope_along(const TractionColumns& cells, const double* x, const double* y);

/// The step: tractions += alpha d, displacements += alpha A d; d becomes alpha d.
IterationChange step_tractions(const TractionColumns& cells, double alpha);

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

/// Cells at their limit that are to move against their friction do not slip: that would give work.
/// Their residual is left to the next step.
void clear_false_slip(const TractionColumns& cells);

}  // namespace torsion::engine
