#pragma once

// A step of the tractions together with the body that gives way as a whole under them.

#include "systems/patch/passes.hpp"
#include "systems/patch/solver.hpp"

namespace torsion {

/// What the cells ask for.
struct StepRequest {
  double stiffness = 0.0;  // Pa/m, of a cell on its own
  bool alone = false;      // each as if its neighbours stayed; else with them
  double share = 1.0;      // of what is asked, to be taken
  double before = 0.0;     // TractionSweep::square of the last step, 0: keep nothing of that
};

/// Both components, over the cells.
struct BothColumns {
  double *x, *y;
};

/// asked = what the cells ask for to be displaced as wanted.
/// @param wanted  m
/// @param asked   Pa, out
void ask_for_both(const PatchProblem& problem, const StepRequest& request,
                  const BothColumns& wanted, PatchWork& work, const BothColumns& asked);

/// What a step starts from and would do.
struct TractionSweep {
  double square = 0.0;  // of the residual under the preconditioner
  TractionStep step;
};

/// Finds the cells' step and the body's motion by it at once: on a slender body the friction that a
/// few cells lose when they come to slip throws the end aside by a thousand times what they
/// displace themselves, and a step that only its cells had chosen would not be short enough.
/// Where nothing slips these are conjugate gradients whose preconditioner has the body's motion in
/// it (Woodbury's formula; Golub and Van Loan, Matrix Computations, 2.1); what slips is projected
/// with the body in balance (disc_projection.hpp).
TractionSweep find_balanced_step(const PatchProblem& problem, const StepRequest& request,
                                 const TractionColumns& cells, PatchWork& work);

}  // namespace torsion
