#include "systems/patch/solver.hpp"

#include <algorithm>

#include "systems/patch/passes.hpp"
#include "systems/patch/sums.hpp"

namespace torsion {
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
  bordered.assign(std::size_t{side + 2} * (side + 2) + kPatchLanes, 0.0);
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
