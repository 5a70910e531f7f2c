#pragma once

// The loops over cells of the contact model `patch`, free of branches and compiled for the widest
// vectors there are. Every column is `count` long, a multiple of kPatchLanes; rows beyond the cells
// are zero, and stay so.

#include <cstddef>
#include <cstdint>

#include "systems/contact_models/local_inverse.hpp"

namespace torsion {

/// Partial sums, the same ones in vectors of any width.
inline constexpr std::size_t kPatchLanes = 8;

constexpr std::size_t whole_lanes(std::size_t count) {
  return (count + kPatchLanes - 1) / kPatchLanes * kPatchLanes;
}

/// How much a sweep changes, Pa.
struct SweepChange {
  double largest = 0.0;
  double sum = 0.0;  // over the cells, both components
};

/// Sum of products.
double dot(std::size_t count, const double* a, const double* b);

/// The largest of the values and 0.
double largest(std::size_t count, const double* values);

/// to += scale * values; of any length.
void add_scaled(std::size_t count, double scale, const double* values, double* to);

/// asked = inverse times scale times wanted, both with a border of one cell around side x side.
/// The border of `asked` is left as it is.
void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* wanted, double* asked);

// pressures ---------------------------------------------------------------------------------------

/// The gap that is left to close, m: where there is pressure, and where the surfaces overlap.
void find_overlaps(std::size_t count, const double* depth, const double* depression,
                   const double* pressure, double* residual);

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
/// least. Of any length.
/// @param change_pressure, change_x, change_y  Pa, out
void lose_cells(std::size_t count, double least_depth, const double* depth, double* pressure,
                double* traction_x, double* traction_y, double* change_pressure, double* change_x,
                double* change_y);

// tractions ---------------------------------------------------------------------------------------

/// The cells that can carry a load, one after another.
struct TractionColumns {
  std::size_t count = 0;
  double *traction_x, *traction_y;  // Pa
  double *target_x, *target_y;      // m
  double *moved_x, *moved_y;        // m
  double* limit;                    // Pa: of the friction
  double* slips;                    // 1 or 0
  double *residual_x, *residual_y;  // m: what a cell asks to be moved by
  double *asked_x, *asked_y;        // Pa
  double *along_x, *along_y;        // unit: of the friction of a cell that slips
  double* softened;                 // of what turns it: 1 where nothing slips
  double *step_x, *step_y;          // Pa: the last change
  double* clips;                    // 1 where a step is cut off at the disc's rim, else 0
  double *moves_x, *moves_y;        // m: what it displaces
};

inline constexpr std::size_t kTractionColumns = 20;

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
  double slips = 0.0;    // cells that end on their discs' rims
  double clipped = 0.0;  // of those the ones that have stuck
};

/// Turns what is asked and kept into a step that ends within the discs.
TractionStep mix_tractions(const TractionColumns& cells, const Mix& mix);

/// Goes `length` of the step, which becomes the change.
SweepChange change_tractions(const TractionColumns& cells, double length);

/// Which cells can carry a load or have to lose one: 1, else 0. Of any length.
void find_loads(std::size_t count, const double* friction, const double* pressure,
                const double* traction_x, const double* traction_y, double* loaded);

}  // namespace torsion
