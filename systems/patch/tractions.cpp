// The tangential tractions of the contact model `patch`.

#include <algorithm>
#include <cmath>

#include "systems/half_space/local_inverse.hpp"
#include "systems/patch/balanced_step.hpp"
#include "systems/patch/sums.hpp"
#include "systems/patch/traction_passes.hpp"

namespace torsion {
namespace {

// Of what is asked, where there is no telling how far to go: the local inverse asks for too much of
// what is smooth, the more so the more cells lie across it.
constexpr double kCalm = 0.6;
constexpr double kCalmSide = 16.0;  // cells along a side, beyond which it is less
constexpr double kShort = 0.05;     // of a step: so bent that it leads nowhere

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
          work.asked_x.data(),
          work.asked_y.data(),
          work.along_x.data(),
          work.along_y.data(),
          work.softened.data(),
          work.step_x.data(),
          work.step_y.data(),
          work.clips.data(),
          work.moves_x.data(),
          work.moves_y.data()};
}

/// What the step displaces.
/// @return the energy's curvature along it, Pa m
double move(const PatchProblem& problem, const TractionColumns& cells, PatchWork& work) {
  move_by_traction(problem, work);
  return dot(cells.count, cells.step_x, cells.step_y, cells.moves_x, cells.moves_y);
}

/// Pa/m, of a cell on its own.
double stiffness_alone(const PatchProblem& problem) {
  const InfluenceTables& tables = problem.influences;
  const double softest = std::max(tables.self(InfluenceKind::kXX), tables.self(InfluenceKind::kYY));
  return 1.0 / (softest * problem.compliance);
}

/// Where a sweep begins.
struct SweepStart {
  bool outside = false;  // a traction is out of its disc
  bool alone = false;    // the last step was as good as none
  double calm = 0.0;
  double before = 0.0;  // the residual's square, 0: no direction to keep
};

/// The step of cells on a body that does not give way as a whole.
TractionSweep find_cells_step(const PatchProblem& problem, const StepRequest& request,
                              const TractionColumns& cells, PatchWork& work) {
  find_ways(cells, request.stiffness);
  ask_for_both(problem, request, {cells.residual_x, cells.residual_y}, work,
               {cells.asked_x, cells.asked_y});
  TractionSweep sweep;
  sweep.square = dot(cells.count, cells.residual_x, cells.residual_y, cells.asked_x, cells.asked_y);
  const double kept = request.before > 0.0 ? sweep.square / request.before : 0.0;
  sweep.step = mix_tractions(cells, {request.share, kept});
  return sweep;
}

TractionSweep find_step(const PatchProblem& problem, double stiffness, const SweepStart& start,
                        const TractionColumns& cells, PatchWork& work) {
  const auto find = problem.support.soft ? find_balanced_step : find_cells_step;
  const double share = start.outside ? start.calm : 1.0;
  TractionSweep sweep = find(problem, {stiffness, false, share, start.before}, cells, work);
  if (!start.outside && (start.alone || sweep.step.slope <= 0.0)) {
    // Beside cells that slip the neighbours' share may lead uphill; each cell's own does not.
    const double clipped = sweep.step.clipped;
    sweep.step = find(problem, {stiffness, true, 1.0, 0.0}, cells, work).step;
    sweep.step.clipped += clipped;
  }
  return sweep;
}

}  // namespace

PatchOutcome relax_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const double alone_stiffness = stiffness_alone(problem);
  const TractionColumns cells = columns_of(columns, work);
  const double fewer = std::min(1.0, kCalmSide / static_cast<double>(tables.side));
  SweepStart start;
  start.calm = kCalm * fewer * fewer;
  start.outside = find_limits(cells);
  std::ranges::fill(work.step_x, 0.0);
  std::ranges::fill(work.step_y, 0.0);
  PatchOutcome outcome;
  double whole = problem.foreseen_traction;
  while (outcome.sweeps < problem.sweeps) {
    const TractionSweep sweep = find_step(problem, alone_stiffness, start, cells, work);
    const double stiffness = move(problem, cells, work);
    if (stiffness <= 0.0) {
      // Nothing is left to do; or the equations have no solution, which is no small residual.
      outcome.last_change = sweep.square > 0.0 ? 1.0 : 0.0;
      break;
    }
    // A first step brings all tractions into their discs, so it goes all the way. Where something
    // slips, a step ends on the discs' rims: no farther.
    const double best = start.outside ? 1.0 : sweep.step.slope / stiffness;
    const double length = sweep.step.slips > 0.0 ? std::clamp(best, 0.0, 1.0) : best;
    const bool exact = !start.outside && sweep.step.clipped == 0.0;
    const SweepChange change = change_tractions(cells, length);
    start = {false, length < kShort, start.calm, exact ? sweep.square : 0.0};
    whole = std::max(whole, change.sum);
    outcome.last_change = change.largest / problem.reference;
    ++outcome.sweeps;
    if (!start.alone && ends(problem, change, whole)) {
      break;
    }
  }
  keep_what_is_no_slip(cells);
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

}  // namespace torsion
