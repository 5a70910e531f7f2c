// The solution of the contact model `patch`: pressures and tractions in turn.

#include <algorithm>

#include "systems/patch/passes.hpp"
#include "systems/patch/solver.hpp"
#include "systems/patch/sums.hpp"

namespace torsion::engine {
namespace {

// Where cells slip, pressures that change by p change friction by mu p, and that displaces the
// surface along its normal as beta mu p of pressure would, a quarter of a wave aside: for a wave of
// any length the influences kZX and kZZ have the ratio i beta (their Fourier transforms). So a
// round multiplies an error by an imaginary number of at most s = mu beta, and where s > 1 errors
// would grow from round to round. Instead, a round presses to the mean of the tool's surface and of
// what the pressures of two rounds ago displace: Chebyshev's iteration for imaginary numbers. It
// leaves 1 / |T_n(i / s)| of an error after n rounds, T_n Chebyshev's polynomial. The mean is one
// of depths, before pressures end at 0. Means of the pressures themselves were measured not to
// converge from s = 1: what ends at 0 is then no projection any more, and a projection lets no
// error grow. Golub and Varga, Numerische Mathematik 3 (1961) 147; Niethammer and Varga, ibid. 41
// (1983) 177.

// Of an error, in a step. Extrapolation needs less than 0.4: it would let imaginary errors grow.
constexpr double kLeft = 0.3;
// The largest s that is counted; twelve rounds leave kLeft then. Friction that is so high seldom
// slips: at mu beta = 10 to 500 this s was measured to leave less than a larger one.
constexpr double kMostFeedback = 6.0;
constexpr std::uint32_t kIterationsOfRound = 2;  // at least, if there may be as many in all

/// How many rounds leave kLeft of an error.
std::uint32_t rounds_for(double feedback) {
  // |T_n(i / s)|
  double last = 1.0;
  double now = 1.0 / feedback;
  std::uint32_t rounds = 1;
  while (now * kLeft < 1.0) {
    const double next = 2.0 * now / feedback + last;
    last = now;
    now = next;
    ++rounds;
  }
  return rounds;
}

/// The tool's share of the mean in a round, 1 in the first two: one makes the tractions those of
/// the pressures, one is to be averaged with.
/// @param last  that of the round before
double share_of_tool(double feedback, std::uint32_t round, double last) {
  const double square = feedback * feedback;
  return round < 2 ? 1.0 : 1.0 / (1.0 + (round == 2 ? 0.5 : 0.25 * last) * square);
}

/// Whether pressures displace the surface along itself, and tractions along its normal.
bool is_coupled(const PatchProblem& problem) {
  return problem.coupled || problem.support.response != nullptr;
}

struct Rounds {
  std::uint32_t count = 1;              // at most
  std::uint32_t iterations = 0;         // of one, at most
  std::uint32_t iterations_of_all = 0;  // at most
  bool averaged = false;
  double feedback = 0.0;  // s
};

Rounds plan_rounds(const PatchProblem& problem) {
  Rounds rounds;
  rounds.count = is_coupled(problem) ? problem.rounds : 1;
  rounds.iterations = problem.iterations;
  rounds.iterations_of_all = problem.iterations_of_rounds;
  rounds.feedback = problem.coupled ? std::min(problem.feedback, kMostFeedback) : 0.0;
  rounds.averaged = rounds.feedback > kLeft;
  if (rounds.averaged) {
    rounds.count = std::max(rounds.count, 1 + rounds_for(rounds.feedback));
    rounds.iterations_of_all =
        std::max(rounds.iterations_of_all, kIterationsOfRound * rounds.count);
    rounds.iterations = std::min(
        rounds.iterations, std::max(kIterationsOfRound, rounds.iterations_of_all / rounds.count));
  }
  return rounds;
}

/// change = now - change.
void take_change(std::span<const double> now, std::vector<double>& change) {
  for (std::size_t cell = 0; cell < now.size(); ++cell) {
    change[cell] = now[cell] - change[cell];
  }
}

/// work.depth: the mean of the tool's surface and of what the pressures of two rounds ago displace
/// beside the present tractions.
/// @param share  of the tool's surface
void average_depths(double share, const PatchColumns& columns, PatchWork& work) {
  for (std::size_t cell = 0; cell < columns.depth.size(); ++cell) {
    work.depth[cell] = share * columns.depth[cell] +
                       (1.0 - share) * (columns.depression[cell] - work.change_depression[cell]);
  }
}

/// Solves for the pressures at fixed tractions, then for the tractions at fixed pressures.
/// @param averaged  whether rounds press to a mean
/// @param share     as in average_depths
PatchOutcome solve_in_turn(const PatchProblem& problem, bool averaged, double share,
                           const PatchColumns& columns, PatchWork& work) {
  const bool coupled = is_coupled(problem);
  if (coupled) {
    std::ranges::copy(columns.pressure, work.change_pressure.begin());
    std::ranges::copy(columns.traction_x, work.change_x.begin());
    std::ranges::copy(columns.traction_y, work.change_y.begin());
  }
  PatchColumns pressed = columns;
  if (share < 1.0) {
    average_depths(share, columns, work);
    pressed.depth = work.depth;
  }
  if (averaged) {
    std::ranges::copy(columns.depression, work.change_depression.begin());
  }
  const PatchOutcome normal = solve_pressures(problem, pressed, work);
  if (averaged) {
    take_change(columns.depression, work.change_depression);
  }
  if (coupled) {
    take_change(columns.pressure, work.change_pressure);
    if (problem.coupled) {
      add_sideways(problem, columns, work.change_pressure, work);
    }
    add_support(problem.support, {{}, {}, work.change_pressure},
                {columns.moved_x, columns.moved_y, {}});
  }
  const PatchOutcome tangential = solve_tractions(problem, columns, work);
  if (coupled) {
    take_change(columns.traction_x, work.change_x);
    take_change(columns.traction_y, work.change_y);
    if (problem.coupled) {
      add_depression(problem, columns, work.change_x, work.change_y, work);
    }
    add_support(problem.support, {work.change_x, work.change_y, {}}, {{}, {}, columns.depression});
  }
  return {0.0, std::max(normal.last_change, tangential.last_change),
          std::max(normal.iterations, tangential.iterations)};
}

}  // namespace

PatchOutcome solve_patch(const PatchProblem& problem, const PatchColumns& columns,
                         PatchWork& work) {
  work.inverses = local_inverses(problem.influences);
  PatchOutcome outcome;
  if (problem.reference <= 0.0) {
    std::ranges::fill(columns.slips, 1.0);
    return outcome;
  }
  const Rounds rounds = plan_rounds(problem);
  PatchProblem of_round = problem;
  double share = 1.0;
  for (std::uint32_t round = 0; round < rounds.count; ++round) {
    of_round.iterations =
        std::min(rounds.iterations, rounds.iterations_of_all - outcome.iterations);
    const bool last = round + 1 == rounds.count;
    of_round.traction_iterations = last ? problem.traction_iterations : 0;
    share = rounds.averaged ? share_of_tool(rounds.feedback, round, share) : 1.0;
    const PatchOutcome turn = solve_in_turn(of_round, rounds.averaged, share, columns, work);
    outcome.last_change = turn.last_change;
    outcome.iterations += turn.iterations;
    // A round that presses to a mean may have next to nothing to do before the solution is found.
    const bool done =
        turn.iterations <= 1 && (!rounds.averaged || turn.last_change <= problem.skip);
    if (done || outcome.iterations >= rounds.iterations_of_all) {
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

void release_cells(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work,
                   double least_depth) {
  const bool lost = release_unloaded(
      whole_lanes(columns.pressure.size()), least_depth, columns.depth.data(),
      columns.pressure.data(), columns.traction_x.data(), columns.traction_y.data(),
      work.change_pressure.data(), work.change_x.data(), work.change_y.data());
  if (lost) {
    add_pressure(problem, columns, work.change_pressure, work);
    add_tractions(problem, columns, work.change_x, work.change_y, work);
  }
}

}  // namespace torsion::engine
