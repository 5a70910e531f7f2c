#pragma once

// A step of the tractions together with the body that deflects as a whole under them.

#include "systems/patch/passes.hpp"
#include "systems/patch/solver.hpp"

namespace torsion::engine {

/// How the next search direction is to be found.
struct StepRequest {
  double stiffness = 0.0;  // Pa/m, of a cell on its own
  bool alone = false;      // preconditioner: each cell as if its neighbours stayed; else with them
  double share = 1.0;      // of the preconditioned residual
  double before = 0.0;     // r' z of the last iteration; 0: a new search begins
};

/// Both components, over the cells.
struct BothColumns {
  double *x, *y;
};

/// z of both components.
/// @param residual        r, m
/// @param preconditioned  z, Pa, out
void precondition_both(const PatchProblem& problem, const StepRequest& request,
                       const BothColumns& residual, PatchWork& work,
                       const BothColumns& preconditioned);

/// The residual that an iteration starts from, and its step.
struct TractionIteration {
  double residual_product = 0.0;  // r' z, Pa m
  TractionStep step;
};

/// Finds the cells' step and the body's motion by it at once: on a slender body the friction that a
/// few cells lose when they come to slip throws the end aside by a thousand times what they
/// displace themselves, and a step found from its cells alone would not be short enough.
/// Where nothing slips these are conjugate gradients whose preconditioner has the body's motion in
/// it (Woodbury's formula; Golub and Van Loan, Matrix Computations, 2.1); what slips is projected
/// with the body in balance (disc_projection.hpp).
TractionIteration find_balanced_step(const PatchProblem& problem, const StepRequest& request,
                                     const TractionColumns& cells, PatchWork& work);

}  // namespace torsion::engine
