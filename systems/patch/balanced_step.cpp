#include "systems/patch/balanced_step.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "systems/half_space/influence.hpp"
#include "systems/math/lanes.hpp"
#include "systems/patch/disc_projection.hpp"
#include "systems/patch/sums.hpp"

namespace torsion {
namespace {

constexpr double kNearlyNone = 1e-300;  // keeps 0 / 0 away
constexpr double kOnRim = 1.0 - 1e-12;  // of a limit's square

/// Where the cells go when each answers on its own.
TORSION_WIDEST
void find_trials_alone(std::size_t count, const double* __restrict stiffness,
                       const double* __restrict traction, const double* __restrict target,
                       const double* __restrict moved, double* __restrict trial) {
  for (std::size_t k = 0; k < count; ++k) {
    trial[k] = traction[k] + stiffness[k] * (target[k] - moved[k]);
  }
}

/// Where the cells go by what is asked and kept, before they are brought onto their discs. One that
/// slips is as far out of its disc as it slips: so it takes that much to make it stick.
TORSION_WIDEST
void find_trials(const TractionColumns& cells, const Mix& mix, const double* __restrict stiffness,
                 const double* __restrict step_x, const double* __restrict step_y,
                 double* __restrict trial_x, double* __restrict trial_y) {
  const double* __restrict const slips = cells.slips;
  const double* __restrict const limits = cells.limit;
  const double* __restrict const asked_x = cells.asked_x;
  const double* __restrict const asked_y = cells.asked_y;
  const double* __restrict const along_x = cells.along_x;
  const double* __restrict const along_y = cells.along_y;
  const double* __restrict const softened = cells.softened;
  const double* __restrict const traction_x = cells.traction_x;
  const double* __restrict const traction_y = cells.traction_y;
  const double* __restrict const target_x = cells.target_x;
  const double* __restrict const target_y = cells.target_y;
  const double* __restrict const moved_x = cells.moved_x;
  const double* __restrict const moved_y = cells.moved_y;
  const double share = mix.asked;
  const double kept = mix.kept;
  for (std::size_t k = 0; k < cells.count; ++k) {
    const bool slip = slips[k] != 0.0;
    const double limit = limits[k];
    const double new_x = share * asked_x[k];
    const double new_y = share * asked_y[k];
    const double across = softened[k] * (along_x[k] * new_y - along_y[k] * new_x) +
                          kept * (along_x[k] * step_y[k] - along_y[k] * step_x[k]);
    const double rim_x = limit * along_x[k] - across * along_y[k];
    const double rim_y = limit * along_y[k] + across * along_x[k];
    const double way =
        (target_x[k] - moved_x[k]) * along_x[k] + (target_y[k] - moved_y[k]) * along_y[k];
    const double reach = limit + stiffness[k] * larger(way, 0.0);
    const double scale = reach / std::sqrt(larger(rim_x * rim_x + rim_y * rim_y, kNearlyNone));
    trial_x[k] = slip ? scale * rim_x : traction_x[k] + (new_x + kept * step_x[k]);
    trial_y[k] = slip ? scale * rim_y : traction_y[k] + (new_y + kept * step_y[k]);
  }
}

void set_columns(const PatchProblem& problem, double stiffness, DiscColumns& discs) {
  const PatchSupport& support = problem.support;
  std::ranges::copy(support.place_x, discs.place_x.begin());
  std::ranges::copy(support.place_y, discs.place_y.begin());
  std::fill_n(discs.stiffness.begin(), support.place_x.size(), stiffness);
  const std::span<const double>& root = problem.rims.root;
  for (std::size_t k = 0; k < root.size(); ++k) {
    discs.stiffness[k] *= root[k] * root[k];
  }
}

/// What the cells answer to tractions or displacements, as a load on the body.
SurfaceLoad answered_load(const TractionColumns& cells, const double* x, const double* y,
                          PatchWork& work) {
  std::copy_n(x, cells.count, work.moves_x.begin());  // not needed before there is a step
  std::copy_n(y, cells.count, work.moves_y.begin());
  keep_answered(cells, work.moves_x.data(), work.moves_y.data());
  return load_of(work.discs, work.moves_x.data(), work.moves_y.data());
}

/// What the cells ask for when the body moves along with what they come to.
/// @param load  on the body: in: with whose motion the cells have found their ways; out: when they
///              go there
/// @return TractionSweep::square
double ask_in_balance(const PatchProblem& problem, const StepRequest& request,
                      const TractionColumns& cells, PatchWork& work, SurfaceLoad& load) {
  ask_for_both(problem, request, {cells.residual_x, cells.residual_y}, work,
               {cells.asked_x, cells.asked_y});
  const SurfaceLoad asked = answered_load(cells, cells.asked_x, cells.asked_y, work);
  glm::dmat3 answers(0.0);  // of the cells to the body's motions
  for (std::size_t k = 0; k < 3; ++k) {
    move_as_one(problem.support, k, work.moves_x.data(), work.moves_y.data());
    keep_answered(cells, work.moves_x.data(), work.moves_y.data());
    const BothColumns asks{work.rigid_asks_x[k].data(), work.rigid_asks_y[k].data()};
    ask_for_both(problem, request, {work.moves_x.data(), work.moves_y.data()}, work, asks);
    answers[static_cast<int>(k)] = answered_load(cells, asks.x, asks.y, work);
  }
  const glm::dmat3& yields = problem.support.slides;
  const SurfaceLoad more = glm::inverse(glm::dmat3(1.0) + request.share * answers * yields) *
                           (request.share * asked - load);
  const SurfaceMotion moves = yields * more;
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = -moves[static_cast<int>(k)];
    add_scaled(cells.count, share, work.rigid_asks_x[k].data(), cells.asked_x);
    add_scaled(cells.count, share, work.rigid_asks_y[k].data(), cells.asked_y);
  }
  // The residual is what the cells see of it and the body's motion.
  const double square =
      dot(cells.count, cells.residual_x, cells.residual_y, cells.asked_x, cells.asked_y) +
      glm::dot(yields * load, answered_load(cells, cells.asked_x, cells.asked_y, work));
  load += more;
  return square;
}

/// The step to the discs' results.
TractionStep step_to_results(const DiscColumns& discs, const TractionColumns& cells) {
  TractionStep step;
  for (std::size_t k = 0; k < cells.count; ++k) {
    const double x = discs.result_x[k];
    const double y = discs.result_y[k];
    const double limit = cells.limit[k];
    const bool rim = limit > 0.0 && x * x + y * y >= kOnRim * limit * limit;
    cells.step_x[k] = x - cells.traction_x[k];
    cells.step_y[k] = y - cells.traction_y[k];
    step.slips += rim ? 1.0 : 0.0;
    step.clipped += rim && cells.slips[k] == 0.0 ? 1.0 : 0.0;
  }
  step.slope = slope_along(cells, cells.step_x, cells.step_y);
  return step;
}

}  // namespace

void ask_for_both(const PatchProblem& problem, const StepRequest& request,
                  const BothColumns& wanted, PatchWork& work, const BothColumns& asked) {
  if (!request.alone) {
    ask_for(problem, work.inverses.x, wanted.x, work, asked.x);
    ask_for(problem, work.inverses.y, wanted.y, work, asked.y);
    return;
  }
  for (std::size_t k = 0; k < work.asked_x.size(); ++k) {
    asked.x[k] = request.stiffness * wanted.x[k];
    asked.y[k] = request.stiffness * wanted.y[k];
  }
  const std::span<const double>& root = problem.rims.root;
  for (std::size_t k = 0; k < root.size(); ++k) {
    const double share = root[k] * root[k];
    asked.x[k] *= share;
    asked.y[k] *= share;
  }
}

TractionSweep find_balanced_step(const PatchProblem& problem, const StepRequest& request,
                                 const TractionColumns& cells, PatchWork& work) {
  DiscColumns& discs = work.discs;
  set_columns(problem, request.stiffness, discs);
  const glm::dmat3& yields = problem.support.slides;
  const SurfaceLoad before = load_of(discs, cells.traction_x, cells.traction_y);
  // How far the body goes when each cell answers on its own: with that the others' ways are found,
  // for without it all might seem to slip.
  const double* const stiffness = discs.stiffness.data();
  find_trials_alone(cells.count, stiffness, cells.traction_x, cells.target_x, cells.moved_x,
                    discs.trial_x.data());
  find_trials_alone(cells.count, stiffness, cells.traction_y, cells.target_y, cells.moved_y,
                    discs.trial_y.data());
  const BodyAnswer alone =
      project_in_balance({yields, before, SurfaceLoad(0.0)}, cells.limit, discs);
  TractionColumns moved = cells;
  moved.target_x = work.target_x.data();
  moved.target_y = work.target_y.data();
  take_off_motion(discs, alone.motion, cells.target_x, cells.target_y, work.target_x.data(),
                  work.target_y.data());
  find_ways(moved, request.stiffness);
  TractionSweep sweep;
  SurfaceLoad load = alone.load;
  sweep.square = ask_in_balance(problem, request, cells, work, load);
  const Mix mix{request.share, request.before > 0.0 ? sweep.square / request.before : 0.0};
  find_trials(moved, mix, stiffness, cells.step_x, cells.step_y, discs.trial_x.data(),
              discs.trial_y.data());
  const SurfaceLoad kept = mix.kept * load_of(discs, cells.step_x, cells.step_y);
  project_in_balance({yields, before + kept, load}, cells.limit, discs);
  sweep.step = step_to_results(discs, cells);
  return sweep;
}

}  // namespace torsion
