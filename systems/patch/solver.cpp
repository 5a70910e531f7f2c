// The tangential tractions of the contact model `patch`.

#include "systems/patch/solver.hpp"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/half_space/influence.hpp"
#include "systems/patch/balanced_step.hpp"
#include "systems/patch/passes.hpp"
#include "systems/patch/sums.hpp"

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

// The pressures of the contact model `patch`.

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

namespace {

/// Pressures move the surface sideways, tractions in and out.
bool is_coupled(const PatchProblem& problem) {
  return problem.coupled || problem.support.response != nullptr;
}

/// change = now - change.
void take_change(std::span<const double> now, std::vector<double>& change) {
  for (std::size_t cell = 0; cell < now.size(); ++cell) {
    change[cell] = now[cell] - change[cell];
  }
}

/// One solution for the pressures with the tractions as they are, then one the other way round.
PatchOutcome solve_in_turn(const PatchProblem& problem, const PatchColumns& columns,
                           PatchWork& work) {
  const bool coupled = is_coupled(problem);
  if (coupled) {
    std::ranges::copy(columns.pressure, work.change_pressure.begin());
    std::ranges::copy(columns.traction_x, work.change_x.begin());
    std::ranges::copy(columns.traction_y, work.change_y.begin());
  }
  const PatchOutcome normal = relax_pressures(problem, columns, work);
  if (coupled) {
    take_change(columns.pressure, work.change_pressure);
    if (problem.coupled) {
      add_sideways(problem, columns, work.change_pressure, work);
    }
    add_support(problem.support, {{}, {}, work.change_pressure},
                {columns.moved_x, columns.moved_y, {}});
  }
  const PatchOutcome tangential = relax_tractions(problem, columns, work);
  if (coupled) {
    take_change(columns.traction_x, work.change_x);
    take_change(columns.traction_y, work.change_y);
    if (problem.coupled) {
      add_depression(problem, columns, work.change_x, work.change_y, work);
    }
    add_support(problem.support, {work.change_x, work.change_y, {}}, {{}, {}, columns.depression});
  }
  return {0.0, std::max(normal.last_change, tangential.last_change),
          std::max(normal.sweeps, tangential.sweeps)};
}

}  // namespace

void PatchWork::reserve(std::uint32_t side) {
  const std::size_t count = whole_lanes(std::size_t{side} * side);
  for (std::vector<double>* each :
       {&residual_x, &residual_y, &asked_x, &asked_y, &step_x, &step_y, &moves_x, &moves_y,
        &moves_both, &limit, &along_x, &along_y, &softened, &clips, &change_pressure, &change_x,
        &change_y, &target_x, &target_y}) {
    each->assign(count, 0.0);
  }
  for (auto* each : {&rigid_x, &rigid_y, &rigid_asks_x, &rigid_asks_y}) {
    each->fill(std::vector<double>(count, 0.0));
  }
  discs.reserve(count);
  bordered.assign(std::size_t{side + 2} * (side + 2) + kLanes, 0.0);
  // One more: what does not count is written, too.
  for (std::vector<double>* each : {&scales_x, &scales_y, &scales}) {
    each->assign(2 * (most_pairs(side) + 1), 0.0);
  }
  places.assign(most_pairs(side) + 1, 0);
}

PatchOutcome solve_patch(const PatchProblem& problem, const PatchColumns& columns,
                         PatchWork& work) {
  work.inverses = local_inverses(problem.influences);
  PatchOutcome outcome;
  if (problem.reference <= 0.0) {
    std::ranges::fill(columns.slips, 1.0);
    return outcome;
  }
  const std::uint32_t rounds = is_coupled(problem) ? problem.rounds : 1;
  PatchProblem of_round = problem;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    of_round.sweeps = std::min(problem.sweeps, problem.sweeps_of_rounds - outcome.sweeps);
    const PatchOutcome turn = solve_in_turn(of_round, columns, work);
    outcome.last_change = turn.last_change;
    outcome.sweeps += turn.sweeps;
    if (turn.sweeps <= 1 || outcome.sweeps >= problem.sweeps_of_rounds) {
      break;
    }
  }
  outcome.residual =
      std::max(residual_of_pressures(columns), residual_of_tractions(problem, columns, work));
  return outcome;
}

void displace_patch(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work) {
  std::ranges::fill(columns.depression, 0.0);
  std::ranges::fill(columns.moved_x, 0.0);
  std::ranges::fill(columns.moved_y, 0.0);
  add_pressure(problem, columns, columns.pressure, work);
  add_tractions(problem, columns, columns.traction_x, columns.traction_y, work);
}

void let_go_cells(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work,
                  double least_depth) {
  const bool lost =
      lose_cells(whole_lanes(columns.pressure.size()), least_depth, columns.depth.data(),
                 columns.pressure.data(), columns.traction_x.data(), columns.traction_y.data(),
                 work.change_pressure.data(), work.change_x.data(), work.change_y.data());
  if (lost) {
    add_pressure(problem, columns, work.change_pressure, work);
    add_tractions(problem, columns, work.change_x, work.change_y, work);
  }
}

}  // namespace torsion
