#include "systems/patch/balanced_step.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "systems/half_space/influence.hpp"
#include "systems/math/lanes.hpp"
#include "systems/patch/disc_projection.hpp"
#include "systems/patch/sums.hpp"

namespace torsion::engine {
namespace {

constexpr double kNearlyNone = 1e-300;  // keeps 0 / 0 away
constexpr double kOnRim = 1.0 - 1e-12;  // of a limit's square

/// The result of each cell when it changes alone.
TORSION_WIDEST
void find_trials_alone(std::size_t count, const double* __restrict stiffness,
                       const double* __restrict traction, const double* __restrict target,
                       const double* __restrict moved, double* __restrict trial) {
  for (std::size_t k = 0; k < count; ++k) {
    trial[k] = traction[k] + stiffness[k] * (target[k] - moved[k]);
  }
}

/// Where a full step along the search direction leads before cells are projected onto their discs.
/// A slipping cell lies as far outside of its disc as it slips: it takes that much to make it
/// stick.
TORSION_WIDEST
void find_trials(const TractionColumns& cells, const DirectionShares& shares,
                 const double* __restrict stiffness, const double* __restrict direction_x,
                 const double* __restrict direction_y, double* __restrict trial_x,
                 double* __restrict trial_y) {
  const double* __restrict const slips = cells.slips;
  const double* __restrict const limits = cells.limit;
  const double* __restrict const preconditioned_x = cells.preconditioned_x;
  const double* __restrict const preconditioned_y = cells.preconditioned_y;
  const double* __restrict const along_x = cells.along_x;
  const double* __restrict const along_y = cells.along_y;
  const double* __restrict const softened = cells.softened;
  const double* __restrict const traction_x = cells.traction_x;
  const double* __restrict const traction_y = cells.traction_y;
  const double* __restrict const target_x = cells.target_x;
  const double* __restrict const target_y = cells.target_y;
  const double* __restrict const moved_x = cells.moved_x;
  const double* __restrict const moved_y = cells.moved_y;
  const double share = shares.share;
  const double beta = shares.beta;
  for (std::size_t k = 0; k < cells.count; ++k) {
    const bool slip = slips[k] != 0.0;
    const double limit = limits[k];
    const double new_x = share * preconditioned_x[k];
    const double new_y = share * preconditioned_y[k];
    const double across = softened[k] * (along_x[k] * new_y - along_y[k] * new_x) +
                          beta * (along_x[k] * direction_y[k] - along_y[k] * direction_x[k]);
    const double rim_x = limit * along_x[k] - across * along_y[k];
    const double rim_y = limit * along_y[k] + across * along_x[k];
    const double way =
        (target_x[k] - moved_x[k]) * along_x[k] + (target_y[k] - moved_y[k]) * along_y[k];
    const double reach = limit + stiffness[k] * larger(way, 0.0);
    const double scale = reach / std::sqrt(larger(rim_x * rim_x + rim_y * rim_y, kNearlyNone));
    trial_x[k] = slip ? scale * rim_x : traction_x[k] + (new_x + beta * direction_x[k]);
    trial_y[k] = slip ? scale * rim_y : traction_y[k] + (new_y + beta * direction_y[k]);
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

/// The load on the body by the part of tractions or displacements in which cells can change.
SurfaceLoad free_load(const TractionColumns& cells, const double* x, const double* y,
                      PatchWork& work) {
  std::copy_n(x, cells.count, work.response_x.begin());  // not needed before there is a step
  std::copy_n(y, cells.count, work.response_y.begin());
  project_on_tangents(cells, work.response_x.data(), work.response_y.data());
  return load_of(work.discs, work.response_x.data(), work.response_y.data());
}

/// The preconditioned residual when the body moves with the cells' change.
/// @param load  on the body: in: for whose motion the residuals were found; out: with the change
/// @return r' z, Pa m
double precondition_in_balance(const PatchProblem& problem, const StepRequest& request,
                               const TractionColumns& cells, PatchWork& work, SurfaceLoad& load) {
  precondition_both(problem, request, {cells.residual_x, cells.residual_y}, work,
                    {cells.preconditioned_x, cells.preconditioned_y});
  const SurfaceLoad preconditioned =
      free_load(cells, cells.preconditioned_x, cells.preconditioned_y, work);
  glm::dmat3 stiffness(0.0);  // loads by the cells for motions of the body
  for (std::size_t k = 0; k < 3; ++k) {
    move_as_one(problem.support, k, work.response_x.data(), work.response_y.data());
    project_on_tangents(cells, work.response_x.data(), work.response_y.data());
    const BothColumns tractions{work.rigid_tractions_x[k].data(), work.rigid_tractions_y[k].data()};
    precondition_both(problem, request, {work.response_x.data(), work.response_y.data()}, work,
                      tractions);
    stiffness[static_cast<int>(k)] = free_load(cells, tractions.x, tractions.y, work);
  }
  const glm::dmat3& compliance = problem.support.slides;
  const SurfaceLoad more = glm::inverse(glm::dmat3(1.0) + request.share * stiffness * compliance) *
                           (request.share * preconditioned - load);
  const SurfaceMotion motion = compliance * more;
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = -motion[static_cast<int>(k)];
    add_scaled(cells.count, share, work.rigid_tractions_x[k].data(), cells.preconditioned_x);
    add_scaled(cells.count, share, work.rigid_tractions_y[k].data(), cells.preconditioned_y);
  }
  // The residual has two parts: the motion of the cells and that of the body.
  const double residual_product =
      dot(cells.count, cells.residual_x, cells.residual_y, cells.preconditioned_x,
          cells.preconditioned_y) +
      glm::dot(compliance * load,
               free_load(cells, cells.preconditioned_x, cells.preconditioned_y, work));
  load += more;
  return residual_product;
}

/// The step that leads to the results of the disc projection.
TractionStep step_to_results(const DiscColumns& discs, const TractionColumns& cells) {
  TractionStep step;
  for (std::size_t k = 0; k < cells.count; ++k) {
    const double x = discs.result_x[k];
    const double y = discs.result_y[k];
    const double limit = cells.limit[k];
    const bool rim = limit > 0.0 && x * x + y * y >= kOnRim * limit * limit;
    cells.direction_x[k] = x - cells.traction_x[k];
    cells.direction_y[k] = y - cells.traction_y[k];
    step.slips += rim ? 1.0 : 0.0;
    step.clipped += rim && cells.slips[k] == 0.0 ? 1.0 : 0.0;
  }
  step.slope = slope_along(cells, cells.direction_x, cells.direction_y);
  return step;
}

}  // namespace

void precondition_both(const PatchProblem& problem, const StepRequest& request,
                       const BothColumns& residual, PatchWork& work,
                       const BothColumns& preconditioned) {
  if (!request.alone) {
    precondition(problem, work.inverses.x, residual.x, work, preconditioned.x);
    precondition(problem, work.inverses.y, residual.y, work, preconditioned.y);
    return;
  }
  for (std::size_t k = 0; k < work.preconditioned_x.size(); ++k) {
    preconditioned.x[k] = request.stiffness * residual.x[k];
    preconditioned.y[k] = request.stiffness * residual.y[k];
  }
  const std::span<const double>& root = problem.rims.root;
  for (std::size_t k = 0; k < root.size(); ++k) {
    const double share = root[k] * root[k];
    preconditioned.x[k] *= share;
    preconditioned.y[k] *= share;
  }
}

TractionIteration find_balanced_step(const PatchProblem& problem, const StepRequest& request,
                                     const TractionColumns& cells, PatchWork& work) {
  DiscColumns& discs = work.discs;
  set_columns(problem, request.stiffness, discs);
  const glm::dmat3& compliance = problem.support.slides;
  const SurfaceLoad before = load_of(discs, cells.traction_x, cells.traction_y);
  // The body's motion when each cell changes alone. The residuals are found with it: without it all
  // cells might seem to slip.
  const double* const stiffness = discs.stiffness.data();
  find_trials_alone(cells.count, stiffness, cells.traction_x, cells.target_x, cells.moved_x,
                    discs.trial_x.data());
  find_trials_alone(cells.count, stiffness, cells.traction_y, cells.target_y, cells.moved_y,
                    discs.trial_y.data());
  const BodyAnswer alone =
      project_in_balance({compliance, before, SurfaceLoad(0.0)}, cells.limit, discs);
  TractionColumns moved = cells;
  moved.target_x = work.target_x.data();
  moved.target_y = work.target_y.data();
  take_off_motion(discs, alone.motion, cells.target_x, cells.target_y, work.target_x.data(),
                  work.target_y.data());
  find_residuals(moved, request.stiffness);
  TractionIteration iteration;
  SurfaceLoad load = alone.load;
  iteration.residual_product = precondition_in_balance(problem, request, cells, work, load);
  const DirectionShares shares{
      request.share, request.before > 0.0 ? iteration.residual_product / request.before : 0.0};
  find_trials(moved, shares, stiffness, cells.direction_x, cells.direction_y, discs.trial_x.data(),
              discs.trial_y.data());
  const SurfaceLoad carried = shares.beta * load_of(discs, cells.direction_x, cells.direction_y);
  project_in_balance({compliance, before + carried, load}, cells.limit, discs);
  iteration.step = step_to_results(discs, cells);
  return iteration;
}

}  // namespace torsion::engine
