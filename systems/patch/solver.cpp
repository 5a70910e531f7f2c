// The equations of the contact model `patch`: tangential tractions, and pressures.

#include "systems/patch/solver.hpp"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/half_space/influence.hpp"
#include "systems/patch/balanced_step.hpp"
#include "systems/patch/passes.hpp"
#include "systems/patch/sums.hpp"

namespace torsion::engine {
namespace {

// Share of the preconditioned residual that is taken where no step length can be computed: the
// local inverse overestimates smooth residuals, and more so over more cells.
constexpr double kDamping = 0.6;
constexpr double kDampingSide = 16.0;  // cells along a side, beyond which it is less
constexpr double kShort = 0.05;        // of a step: so bent that it leads nowhere

TractionColumns columns_of(const PatchColumns& columns, PatchWork& work) {
  return {whole_lanes(columns.pressure.size()),
          columns.pressure.data(),
          columns.friction.data(),
          columns.traction_x.data(),
          columns.traction_y.data(),
          columns.target_x.data(),
          columns.target_y.data(),
          columns.moved_x.data(),
          columns.moved_y.data(),
          columns.slips.data(),
          work.limit.data(),
          work.residual_x.data(),
          work.residual_y.data(),
          work.preconditioned_x.data(),
          work.preconditioned_y.data(),
          work.along_x.data(),
          work.along_y.data(),
          work.softened.data(),
          work.direction_x.data(),
          work.direction_y.data(),
          work.clips.data(),
          work.response_x.data(),
          work.response_y.data()};
}

/// A d.
/// @return d' A d, Pa m: the energy's curvature along the search direction
double respond(const PatchProblem& problem, const TractionColumns& cells, PatchWork& work) {
  move_by_traction(problem, work);
  return dot(cells.count, cells.direction_x, cells.direction_y, cells.response_x, cells.response_y);
}

/// Pa/m, of a cell on its own.
double stiffness_alone(const PatchProblem& problem) {
  const InfluenceTables& tables = problem.influences;
  const double softest = std::max(tables.self(InfluenceKind::kXX), tables.self(InfluenceKind::kYY));
  return 1.0 / (softest * problem.compliance);
}

/// The state at the beginning of an iteration.
struct IterationStart {
  bool outside = false;  // a traction is out of its disc
  bool alone = false;    // the last step was as good as none
  double damping = 0.0;
  double before = 0.0;  // r' z of the last iteration, 0: a new search begins
};

/// The step of the cells on a body that does not deflect as a whole.
TractionIteration find_cells_step(const PatchProblem& problem, const StepRequest& request,
                                  const TractionColumns& cells, PatchWork& work) {
  find_residuals(cells, request.stiffness);
  precondition_both(problem, request, {cells.residual_x, cells.residual_y}, work,
                    {cells.preconditioned_x, cells.preconditioned_y});
  TractionIteration iteration;
  iteration.residual_product = dot(cells.count, cells.residual_x, cells.residual_y,
                                   cells.preconditioned_x, cells.preconditioned_y);
  const double beta = request.before > 0.0 ? iteration.residual_product / request.before : 0.0;
  iteration.step = next_traction_direction(cells, {request.share, beta});
  return iteration;
}

TractionIteration find_step(const PatchProblem& problem, double stiffness,
                            const IterationStart& start, const TractionColumns& cells,
                            PatchWork& work) {
  const auto find = problem.support.soft ? find_balanced_step : find_cells_step;
  const double share = start.outside ? start.damping : 1.0;
  TractionIteration iteration = find(problem, {stiffness, false, share, start.before}, cells, work);
  if (!start.outside && (start.alone || iteration.step.slope <= 0.0)) {
    // Beside slipping cells the neighbours' part of the preconditioner may lead uphill; each cell's
    // own part does not.
    const double clipped = iteration.step.clipped;
    iteration.step = find(problem, {stiffness, true, 1.0, 0.0}, cells, work).step;
    iteration.step.clipped += clipped;
  }
  return iteration;
}

}  // namespace

PatchOutcome solve_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const double alone_stiffness = stiffness_alone(problem);
  const TractionColumns cells = columns_of(columns, work);
  const double fewer = std::min(1.0, kDampingSide / static_cast<double>(tables.side));
  IterationStart start;
  start.damping = kDamping * fewer * fewer;
  start.outside = find_limits(cells);
  std::ranges::fill(work.direction_x, 0.0);
  std::ranges::fill(work.direction_y, 0.0);
  PatchOutcome outcome;
  double whole = problem.extrapolated_traction;
  const std::uint32_t most = std::max(problem.iterations, problem.traction_iterations);
  while (outcome.iterations < most) {
    const TractionIteration iteration = find_step(problem, alone_stiffness, start, cells, work);
    const double curvature = respond(problem, cells, work);
    if (curvature <= 0.0) {
      // Either nothing is left to do, or the equations have no solution, which must not look like a
      // small residual.
      outcome.last_change = iteration.residual_product > 0.0 ? 1.0 : 0.0;
      break;
    }
    // A first step brings all tractions into their discs, so it is taken in full. Where cells slip,
    // a step ends on the discs' rims, so it is at most a full one.
    const double best = start.outside ? 1.0 : iteration.step.slope / curvature;
    const double alpha = iteration.step.slips > 0.0 ? std::clamp(best, 0.0, 1.0) : best;
    const bool exact = !start.outside && iteration.step.clipped == 0.0;
    const IterationChange change = step_tractions(cells, alpha);
    start = {false, alpha < kShort, start.damping, exact ? iteration.residual_product : 0.0};
    whole = std::max(whole, change.sum);
    outcome.last_change = change.largest / problem.reference;
    ++outcome.iterations;
    if (!start.alone && has_converged(problem, change, whole)) {
      break;
    }
  }
  clear_false_slip(cells);
  return outcome;
}

double residual_of_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const TractionColumns cells = columns_of(columns, work);
  find_limits(cells);
  const TractionResidual left =
      traction_residual(cells, columns.depth.data(), stiffness_alone(problem));
  return left.scale > 0.0 ? std::sqrt(left.lacking / left.scale) : 0.0;
}

// The pressures of the contact model `patch`.

namespace {

/// The rigid motions of all cells: sinking, and tilting about the grid's axes.
void find_rigid_motions(const PatchProblem& problem, PatchWork& work) {
  const std::span<const double>& x = problem.support.place_x;
  std::fill_n(work.rigid_x[0].begin(), x.size(), 1.0);
  std::ranges::copy(x, work.rigid_x[1].begin());
  std::ranges::copy(problem.support.place_y, work.rigid_x[2].begin());
}

/// The body as a whole deflects, which the local inverse does not contain: z of a soft body would
/// be far too large. With B the local inverse, Z the rigid motions and C their compliance, the
/// preconditioner is the inverse of B^-1 + Z C Z' (Woodbury's formula). Golub and Van Loan, Matrix
/// Computations, 2.1.
void add_rigid_compliance(const PatchProblem& problem, PatchWork& work) {
  const std::size_t count = work.preconditioned_x.size();
  glm::dmat3 stiffness(0.0);  // Z' B Z
  glm::dvec3 loads(0.0);      // Z' B r
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double>& tractions = work.rigid_tractions_x[k];
    std::vector<double>& motion = work.rigid_y[k];  // of the cells that count
    std::ranges::copy(work.rigid_x[k], motion.begin());
    mask_preconditioned(count, work.residual_x.data(), motion.data());
    precondition(problem, work.inverses.z, motion.data(), work, tractions.data());
    const auto column = static_cast<int>(k);
    loads[column] = mask_preconditioned(count, work.residual_x.data(), tractions.data());
    for (std::size_t other = 0; other <= k; ++other) {
      const auto row = static_cast<int>(other);
      stiffness[column][row] = stiffness[row][column] =
          dot(count, tractions.data(), work.rigid_x[other].data());
    }
  }
  const glm::dmat3& compliance = problem.support.sinks;
  const glm::dvec3 back =
      glm::inverse(glm::dmat3(1.0) + compliance * stiffness) * (compliance * loads);
  for (std::size_t k = 0; k < 3; ++k) {
    add_scaled(count, -back[static_cast<int>(k)], work.rigid_tractions_x[k].data(),
               work.preconditioned_x.data());
  }
}

/// The residual r and z = B r, work.preconditioned_x.
/// @return r' z, Pa m
double precondition_residual(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const std::size_t count = work.residual_x.size();
  find_overlaps(count, columns.depth.data(), columns.depression.data(), columns.pressure.data(),
                work.residual_x.data());
  precondition(problem, work.inverses.z, work.residual_x.data(), work,
               work.preconditioned_x.data());
  if (problem.support.soft) {
    add_rigid_compliance(problem, work);
  }
  return mask_preconditioned(count, work.residual_x.data(), work.preconditioned_x.data());
}

/// Takes the step: changes the pressures by alpha d and displaces the surface.
/// @param tension  out: the largest negative pressure after it, Pa
IterationChange go(double alpha, const PatchColumns& columns, PatchWork& work, double& tension) {
  return step_pressures(work.direction_x.size(), alpha, work.response_x.data(),
                        work.direction_x.data(), columns.pressure.data(), columns.depression.data(),
                        tension);
}

/// Sets the pressure of cells under tension to zero.
void release_tension(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work) {
  find_tension(work.direction_x.size(), columns.pressure.data(), work.direction_x.data());
  move_by_pressure(problem, work);
  double none = 0.0;
  go(1.0, columns, work, none);
}

}  // namespace

PatchOutcome solve_pressures(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  std::ranges::fill(work.direction_x, 0.0);
  if (problem.support.soft) {
    find_rigid_motions(problem, work);
  }
  PatchOutcome outcome;
  double before = 0.0;  // r' z of the last iteration, 0: a new search begins
  double whole = problem.extrapolated_pressure;
  const std::size_t count = work.direction_x.size();
  while (outcome.iterations < problem.iterations) {
    const double residual_product = precondition_residual(problem, columns, work);
    const double beta = before > 0.0 ? residual_product / before : 0.0;
    const double slope = next_pressure_direction(
        count, work.residual_x.data(), work.preconditioned_x.data(), beta, work.direction_x.data());
    move_by_pressure(problem, work);
    const double curvature = dot(count, work.direction_x.data(), work.response_x.data());
    if (curvature <= 0.0) {
      // Either nothing is left to do, or the equations have no solution, which must not look like a
      // small residual.
      outcome.last_change = residual_product > 0.0 ? 1.0 : 0.0;
      break;
    }
    const double alpha = slope / curvature;
    double tension = 0.0;
    IterationChange change = go(alpha, columns, work, tension);
    if (tension > 0.0) {
      release_tension(problem, columns, work);
    }
    before = tension > 0.0 ? 0.0 : residual_product;
    change.largest = std::max(change.largest, tension);
    whole = std::max(whole, change.sum);
    outcome.last_change = change.largest / problem.reference;
    ++outcome.iterations;
    if (has_converged(problem, change, whole)) {
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

}  // namespace torsion::engine
