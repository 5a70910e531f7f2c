#pragma once

// The loops of patch/passes.hpp over the tangential tractions.

#include <cstddef>

#include "systems/patch/passes.hpp"

namespace torsion {

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
