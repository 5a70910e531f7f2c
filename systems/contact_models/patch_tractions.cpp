// The tangential tractions of the contact model `patch`.

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "systems/contact_models/deflation.hpp"
#include "systems/contact_models/local_inverse.hpp"
#include "systems/contact_models/patch_sums.hpp"
#include "systems/contact_models/traction_passes.hpp"

namespace torsion {
namespace {

// Of what is asked, where there is no telling how far to go: the local inverse asks for too much of
// what is smooth, the more so the more cells lie across it.
constexpr double kCalm = 0.6;
constexpr double kCalmSide = 16.0;  // cells along a side, beyond which it is less
constexpr double kShort = 0.05;     // of a step: so bent that it leads nowhere

/// What one sweep finds.
struct Sweep {
  double square = 0.0;  // of the residual under the preconditioner
  TractionStep step;
};

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

/// As for the pressures (patch_pressures.cpp): to sliding along x and y, and turning.
void yield_to_rigid_motions(const PatchProblem& problem, const TractionColumns& cells,
                            PatchWork& work) {
  glm::dmat3 stiffness(0.0);
  glm::dvec3 asked(0.0);
  std::vector<double>& answers_x = work.moves_x;  // not needed before there is a step
  std::vector<double>& answers_y = work.moves_y;
  const std::size_t count = work.rigid_x[0].size();
  for (std::size_t k = 0; k < 3; ++k) {
    double* const motion_x = work.rigid_x[k].data();
    double* const motion_y = work.rigid_y[k].data();
    move_as_one(problem.support, k, motion_x, motion_y);
    const auto answer = [&](const double* x, const double* y) {
      std::copy_n(x, count, answers_x.begin());
      std::copy_n(y, count, answers_y.begin());
      keep_answered(cells, answers_x.data(), answers_y.data());
    };
    answer(motion_x, motion_y);
    double* const asks_x = work.rigid_asks_x[k].data();
    double* const asks_y = work.rigid_asks_y[k].data();
    ask_for(problem, work.inverses.x, answers_x.data(), work, asks_x);
    ask_for(problem, work.inverses.y, answers_y.data(), work, asks_y);
    const auto column = static_cast<int>(k);
    asked[column] = dot(count, asks_x, asks_y, cells.residual_x, cells.residual_y);
    answer(asks_x, asks_y);
    for (std::size_t other = 0; other <= k; ++other) {
      const auto row = static_cast<int>(other);
      stiffness[column][row] = stiffness[row][column] =
          dot(count, answers_x.data(), answers_y.data(), work.rigid_x[other].data(),
              work.rigid_y[other].data());
    }
  }
  const glm::dmat3& yields = problem.support.slides;
  const glm::dvec3 back = glm::inverse(glm::dmat3(1.0) + yields * stiffness) * (yields * asked);
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = -back[static_cast<int>(k)];
    add_scaled(cells.count, share, work.rigid_asks_x[k].data(), cells.asked_x);
    add_scaled(cells.count, share, work.rigid_asks_y[k].data(), cells.asked_y);
  }
}

/// What is left of every cell's way, and what it asks for.
/// @return the sum of the residual's squares under the preconditioner
double ask(const PatchProblem& problem, double stiffness, const TractionColumns& cells,
           PatchWork& work) {
  find_ways(cells, stiffness);
  ask_for(problem, work.inverses.x, cells.residual_x, work, cells.asked_x);
  ask_for(problem, work.inverses.y, cells.residual_y, work, cells.asked_y);
  if (problem.support.soft && !problem.support.sways) {
    yield_to_rigid_motions(problem, cells, work);
  }
  return dot(cells.count, cells.residual_x, cells.residual_y, cells.asked_x, cells.asked_y);
}

/// What every cell asks for if its neighbours stay.
void ask_alone(const PatchProblem& problem, double stiffness, const TractionColumns& cells) {
  for (std::size_t k = 0; k < cells.count; ++k) {
    cells.asked_x[k] = stiffness * cells.residual_x[k];
    cells.asked_y[k] = stiffness * cells.residual_y[k];
  }
  const std::span<const double>& root = problem.rims.root;
  for (std::size_t k = 0; k < root.size(); ++k) {
    const double share = root[k] * root[k];
    cells.asked_x[k] *= share;
    cells.asked_y[k] *= share;
  }
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

/// Brings the body into balance by the cells that stick now.
Deflation deflate(const PatchProblem& problem, double stiffness, const TractionColumns& cells,
                  PatchWork& work) {
  find_ways(cells, stiffness);
  const Deflation deflation = find_deflation(problem, cells, work);
  balance(deflation, cells, work);
  return deflation;
}

/// Where a sweep begins.
struct SweepStart {
  bool outside = false;  // a traction is out of its disc
  bool alone = false;    // the last step was as good as none
  double calm = 0.0;
  double before = 0.0;  // the residual's square, 0: no direction to keep
};

Sweep find_step(const PatchProblem& problem, double stiffness, const SweepStart& start,
                const Deflation& deflation, const TractionColumns& cells, PatchWork& work) {
  Sweep sweep;
  sweep.square = ask(problem, stiffness, cells, work);
  const double kept = start.before > 0.0 ? sweep.square / start.before : 0.0;
  sweep.step = mix_tractions(cells, {start.outside ? start.calm : 1.0, kept});
  if (!start.outside && (start.alone || sweep.step.slope <= 0.0)) {
    // Beside cells that slip the neighbours' share may lead uphill; each cell's own does not.
    ask_alone(problem, stiffness, cells);
    const double clipped = sweep.step.clipped;
    sweep.step = mix_tractions(cells, {1.0, 0.0});
    sweep.step.clipped += clipped;
  }
  if (deflation.directions > 0) {
    make_conjugate(deflation, cells, work);
    sweep.step.slope = slope_along(cells, cells.step_x, cells.step_y);
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
  const bool sways = problem.support.sways;
  SweepStart start;
  start.calm = kCalm * fewer * fewer;
  start.outside = find_limits(cells);
  std::ranges::fill(work.step_x, 0.0);
  std::ranges::fill(work.step_y, 0.0);
  PatchOutcome outcome;
  double whole = problem.foreseen_traction;
  Deflation deflation = sways ? deflate(problem, alone_stiffness, cells, work) : Deflation{};
  while (outcome.sweeps < problem.sweeps) {
    if (sways && start.alone && outcome.sweeps + 1 < problem.sweeps) {
      // Other cells stick than did, and the body's balance has drawn some out of their discs.
      deflation = deflate(problem, alone_stiffness, cells, work);
      start.outside = find_limits(cells);
      start.before = 0.0;
    }
    const Sweep sweep = find_step(problem, alone_stiffness, start, deflation, cells, work);
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
    SweepChange change = change_tractions(cells, length);
    const SweepChange balanced = balance(deflation, cells, work);
    change.largest += balanced.largest;
    change.sum += balanced.sum;
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
