// The pressures of the contact model `patch`.

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/contact_models/local_inverse.hpp"
#include "systems/contact_models/patch_sums.hpp"

namespace torsion {
namespace {

/// Takes back what of `asked` the body as a whole gives way by, so that a soft body is not asked
/// for more than it needs: with B the local inverse, Z the rigid motions and C their compliance,
/// the inverse of B^-1 + Z C Z' (Woodbury's formula). Golub and Van Loan, Matrix Computations, 2.1.
void yield_to_rigid_motions(const PatchProblem& problem, const LocalInverse& inverse,
                            PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  glm::dmat3 stiffness(0.0);  // Z' B Z
  glm::dvec3 asked(0.0);      // Z' B times the residual
  const auto motion = [&problem](std::size_t k, std::size_t cell) {
    return k == 0 ? 1.0 : (k == 1 ? problem.support.place_x : problem.support.place_y)[cell];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t cell = 0;
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::size_t row = std::size_t{j + 1} * (side + 2) + 1;
      for (std::uint32_t i = 0; i < side; ++i, ++cell) {
        work.rigid_x[row + i] = work.residual_x[row + i] != 0.0 ? motion(k, cell) : 0.0;
      }
    }
    apply_local_inverse(inverse, 1.0 / problem.compliance, side, work.rigid_x,
                        work.rigid_asks_x[k]);
    cell = 0;
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::size_t row = std::size_t{j + 1} * (side + 2) + 1;
      for (std::uint32_t i = 0; i < side; ++i, ++cell) {
        const double residual = work.residual_x[row + i];
        const double asks = residual != 0.0 ? work.rigid_asks_x[k][cell] : 0.0;
        const auto column = static_cast<int>(k);
        asked[column] += asks * residual;
        stiffness[column] +=
            asks * glm::dvec3(1.0, problem.support.place_x[cell], problem.support.place_y[cell]);
      }
    }
  }
  const glm::dmat3& yields = problem.support.sinks;
  const glm::dvec3 back = glm::inverse(glm::dmat3(1.0) + yields * stiffness) * (yields * asked);
  for (std::size_t cell = 0; cell < work.asked_x.size(); ++cell) {
    work.asked_x[cell] -= back.x * work.rigid_asks_x[0][cell] +
                          back.y * work.rigid_asks_x[1][cell] + back.z * work.rigid_asks_x[2][cell];
  }
}

/// The gap that is left to close, m: where there is pressure, and where the surfaces overlap.
/// @return the sum of its squares under the preconditioner, after which `asked` holds what it asks
double ask(const PatchProblem& problem, const PatchColumns& columns, const LocalInverse& inverse,
           PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    double* const residual = work.residual_x.data() + std::size_t{j + 1} * (side + 2) + 1;
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      const double overlap = columns.depth[cell] - columns.depression[cell];
      residual[i] = columns.pressure[cell] > 0.0 || overlap > 0.0 ? overlap : 0.0;
    }
  }
  apply_local_inverse(inverse, 1.0 / problem.compliance, side, work.residual_x, work.asked_x);
  if (problem.support.soft) {
    yield_to_rigid_motions(problem, inverse, work);
  }
  double square = 0.0;
  cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    const double* const residual = work.residual_x.data() + std::size_t{j + 1} * (side + 2) + 1;
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      work.asked_x[cell] = residual[i] != 0.0 ? work.asked_x[cell] : 0.0;
      square += residual[i] * work.asked_x[cell];
    }
  }
  return square;
}

/// work.step_x = what is asked, and `kept` of the last step.
/// @return the slope of the energy along it, downhill, Pa m
double take_step(double kept, const PatchColumns& columns, PatchWork& work) {
  double slope = 0.0;
  for (std::size_t cell = 0; cell < columns.pressure.size(); ++cell) {
    const double asked = work.asked_x[cell];
    const double change = asked != 0.0 ? asked + kept * work.step_x[cell] : 0.0;
    work.step_x[cell] = change;
    slope += (columns.depth[cell] - columns.depression[cell]) * change;
  }
  return slope;
}

double stiffness_along(const PatchWork& work) {
  double stiffness = 0.0;
  for (std::size_t cell = 0; cell < work.step_x.size(); ++cell) {
    stiffness += work.step_x[cell] * work.moves_x[cell];
  }
  return stiffness;
}

/// Changes pressures by `length` of the step and displaces the surface.
SweepChange go(const PatchColumns& columns, double length, PatchWork& work) {
  SweepChange change;
  for (std::size_t cell = 0; cell < columns.pressure.size(); ++cell) {
    work.step_x[cell] *= length;
    change.largest = std::max(change.largest, std::abs(work.step_x[cell]));
    change.sum += std::abs(work.step_x[cell]);
    columns.pressure[cell] += work.step_x[cell];
    columns.depression[cell] += length * work.moves_x[cell];
  }
  return change;
}

/// Lets the cells go that pull.
/// @return the largest pull, Pa
double let_go(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work) {
  double largest = 0.0;
  for (std::size_t cell = 0; cell < columns.pressure.size(); ++cell) {
    work.step_x[cell] = std::max(0.0, -columns.pressure[cell]);
    largest = std::max(largest, work.step_x[cell]);
  }
  if (largest > 0.0) {
    move_by_pressure(problem, work);
    go(columns, 1.0, work);
  }
  return largest;
}

}  // namespace

PatchOutcome relax_pressures(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const LocalInverse inverse = local_inverse(problem.influences, InfluenceKind::kZZ);
  PatchOutcome outcome;
  double before = 0.0;  // the residual's square, 0: no direction to keep
  double whole = problem.foreseen_pressure;
  while (outcome.sweeps < problem.sweeps) {
    const double square = ask(problem, columns, inverse, work);
    const double slope = take_step(before > 0.0 ? square / before : 0.0, columns, work);
    move_by_pressure(problem, work);
    const double stiffness = stiffness_along(work);
    if (stiffness <= 0.0) {
      outcome.residual = 0.0;
      break;
    }
    SweepChange change = go(columns, slope / stiffness, work);
    const double pull = let_go(problem, columns, work);
    before = pull > 0.0 ? 0.0 : square;
    change.largest = std::max(change.largest, pull);
    whole = std::max(whole, change.sum);
    outcome.residual = change.largest / problem.reference;
    ++outcome.sweeps;
    if (ends(problem, change, whole)) {
      break;
    }
  }
  return outcome;
}

}  // namespace torsion
