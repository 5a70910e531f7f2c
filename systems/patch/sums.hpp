#pragma once

// What changes of pressures and tractions do to the surface, for the solver of the contact model
// `patch`.

#include <span>

#include "systems/half_space/sum_influence.hpp"
#include "systems/patch/passes.hpp"
#include "systems/patch/solver.hpp"

namespace torsion::engine {

/// True when an iteration changes so little that it can be the last.
inline bool has_converged(const PatchProblem& problem, const IterationChange& change,
                          double whole) {
  return change.largest <= problem.skip * problem.reference ||
         change.sum <= problem.settled * whole;
}

/// For displacements (side x side).
inline GridBlock block_of(const InfluenceTables& tables) {
  return {tables.side, tables.side, tables.width(), tables.index(0, 0, 0, 0)};
}

/// The displacements of the cells when all of them slide along x (motion 0) or y (1) by 1, or turn
/// about the grid's origin by 1 (2). What follows the cells stays.
void move_as_one(const PatchSupport& support, std::size_t motion, double* x, double* y);

/// displacement += what tractions do in cells at rims beyond the influence tables.
/// @param kind  of these, of a traction along the displacement
/// @param sign  1, or -1 to take it off
void add_rims(const PatchProblem& problem, InfluenceKind kind, double sign,
              std::span<const double> traction, std::span<double> displacement);

/// The preconditioner: z = B r with B the local inverse of the influences.
/// @param residual        r, m, (side x side)
/// @param preconditioned  z, Pa, (side x side) out
void precondition(const PatchProblem& problem, const LocalInverse& inverse, const double* residual,
                  PatchWork& work, double* preconditioned);

/// Adds to the displacements what changes of the pressure do.
void add_pressure(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work);

/// Adds to the displacements what changes of the tangential tractions do.
void add_tractions(const PatchProblem& problem, const PatchColumns& columns,
                   std::span<const double> change_x, std::span<const double> change_y,
                   PatchWork& work);

/// Only to those along the surface what changes of the pressure do sideways.
/// @param change  Pa, (side x side)
void add_sideways(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work);

/// Only to the depression what changes of the tangential tractions do.
void add_depression(const PatchProblem& problem, const PatchColumns& columns,
                    std::span<const double> change_x, std::span<const double> change_y,
                    PatchWork& work);

/// A d: work.response_x = depression by work.direction_x.
void move_by_pressure(const PatchProblem& problem, PatchWork& work);

/// A d: work.response_x, response_y = displacement along the surface by work.direction_x,
/// direction_y.
void move_by_traction(const PatchProblem& problem, PatchWork& work);

/// Conjugate gradients for the pressures until they have converged, or for as many iterations as
/// there may be.
PatchOutcome solve_pressures(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work);

/// Projected conjugate gradients for the tangential tractions, likewise.
PatchOutcome solve_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work);

/// PatchOutcome::residual of the one and of the other; 0 where there is no overlap or no friction.
double residual_of_pressures(const PatchColumns& columns);
double residual_of_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work);

}  // namespace torsion::engine
