// The pressures of the contact model `patch`.

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/half_space/local_inverse.hpp"
#include "systems/patch/sums.hpp"

namespace torsion {
namespace {

/// The rigid motions of all cells: sinking, and tilting about the grid's axes.
void find_rigid_motions(const PatchProblem& problem, PatchWork& work) {
  const std::span<const double>& x = problem.support.place_x;
  std::fill_n(work.rigid_x[0].begin(), x.size(), 1.0);
  std::ranges::copy(x, work.rigid_x[1].begin());
  std::ranges::copy(problem.support.place_y, work.rigid_x[2].begin());
}

/// Takes back what of `asked` the body as a whole gives way by, so that a soft body is not asked
/// for more than it needs: with B the local inverse, Z the rigid motions and C their compliance,
/// the inverse of B^-1 + Z C Z' (Woodbury's formula). Golub and Van Loan, Matrix Computations, 2.1.
void yield_to_rigid_motions(const PatchProblem& problem, PatchWork& work) {
  const std::size_t count = work.asked_x.size();
  glm::dmat3 stiffness(0.0);  // Z' B Z
  glm::dvec3 asked(0.0);      // Z' B times the residual
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double>& asks = work.rigid_asks_x[k];
    std::vector<double>& motion = work.rigid_y[k];  // of the cells that count
    std::ranges::copy(work.rigid_x[k], motion.begin());
    keep_asked(count, work.residual_x.data(), motion.data());
    ask_for(problem, work.inverses.z, motion.data(), work, asks.data());
    const auto column = static_cast<int>(k);
    asked[column] = keep_asked(count, work.residual_x.data(), asks.data());
    for (std::size_t other = 0; other <= k; ++other) {
      const auto row = static_cast<int>(other);
      stiffness[column][row] = stiffness[row][column] =
          dot(count, asks.data(), work.rigid_x[other].data());
    }
  }
  const glm::dmat3& yields = problem.support.sinks;
  const glm::dvec3 back = glm::inverse(glm::dmat3(1.0) + yields * stiffness) * (yields * asked);
  for (std::size_t k = 0; k < 3; ++k) {
    add_scaled(count, -back[static_cast<int>(k)], work.rigid_asks_x[k].data(), work.asked_x.data());
  }
}

/// @return the sum of the residual's squares under the preconditioner, after which `asked` holds
/// what it asks
double ask(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work) {
  const std::size_t count = work.residual_x.size();
  find_overlaps(count, columns.depth.data(), columns.depression.data(), columns.pressure.data(),
                work.residual_x.data());
  ask_for(problem, work.inverses.z, work.residual_x.data(), work, work.asked_x.data());
  if (problem.support.soft) {
    yield_to_rigid_motions(problem, work);
  }
  return keep_asked(count, work.residual_x.data(), work.asked_x.data());
}

/// Changes pressures by `length` of the step and displaces the surface.
/// @param pull  the largest that there is then, Pa
SweepChange go(double length, const PatchColumns& columns, PatchWork& work, double& pull) {
  return change_pressures(work.step_x.size(), length, work.moves_x.data(), work.step_x.data(),
                          columns.pressure.data(), columns.depression.data(), pull);
}

/// Lets the cells go that pull.
void let_go(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work) {
  find_pulls(work.step_x.size(), columns.pressure.data(), work.step_x.data());
  move_by_pressure(problem, work);
  double none = 0.0;
  go(1.0, columns, work, none);
}

}  // namespace

PatchOutcome relax_pressures(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  std::ranges::fill(work.step_x, 0.0);
  if (problem.support.soft) {
    find_rigid_motions(problem, work);
  }
  PatchOutcome outcome;
  double before = 0.0;  // the residual's square, 0: no direction to keep
  double whole = problem.foreseen_pressure;
  const std::size_t count = work.step_x.size();
  while (outcome.sweeps < problem.sweeps) {
    const double square = ask(problem, columns, work);
    const double slope = mix_pressures(count, work.residual_x.data(), work.asked_x.data(),
                                       before > 0.0 ? square / before : 0.0, work.step_x.data());
    move_by_pressure(problem, work);
    const double stiffness = dot(count, work.step_x.data(), work.moves_x.data());
    if (stiffness <= 0.0) {
      // Nothing is left to do; or the equations have no solution, which is no small residual.
      outcome.last_change = square > 0.0 ? 1.0 : 0.0;
      break;
    }
    double pull = 0.0;
    SweepChange change = go(slope / stiffness, columns, work, pull);
    if (pull > 0.0) {
      let_go(problem, columns, work);
    }
    before = pull > 0.0 ? 0.0 : square;
    change.largest = std::max(change.largest, pull);
    whole = std::max(whole, change.sum);
    outcome.last_change = change.largest / problem.reference;
    ++outcome.sweeps;
    if (ends(problem, change, whole)) {
      break;
    }
  }
  return outcome;
}

double residual_of_pressures(const PatchColumns& columns) {
  const PressureResidual left =
      pressure_residual(whole_lanes(columns.pressure.size()), columns.depth.data(),
                        columns.depression.data(), columns.pressure.data());
  return left.scale > 0.0 ? std::sqrt(left.lacking / left.scale) : 0.0;
}

}  // namespace torsion
