#include "systems/contact_models/deflation.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact_models/patch_sums.hpp"

namespace torsion {
namespace {

constexpr std::size_t kMotions = 3;
// Of a direction's curvature, that is left beside those before it: where one cell sticks a turn is
// no other direction than a slide.
constexpr double kLeastLeft = 1e-6;

/// What a motion asks of the cells that stick, and what that displaces.
void find_pull(const PatchProblem& problem, const TractionColumns& cells, std::size_t motion,
               PatchWork& work) {
  move_as_one(problem.support, motion, work.moves_x.data(), work.moves_y.data());
  keep_answered(cells, work.moves_x.data(), work.moves_y.data());
  ask_for(problem, work.inverses.x, work.moves_x.data(), work, cells.step_x);
  ask_for(problem, work.inverses.y, work.moves_y.data(), work, cells.step_y);
  keep_answered(cells, cells.step_x, cells.step_y);
  move_by_traction(problem, work);
}

double curvature(const TractionColumns& cells) {
  return dot(cells.count, cells.step_x, cells.step_y, cells.moves_x, cells.moves_y);
}

/// Of `scale` times the step.
SweepChange size_of(const TractionColumns& cells, double scale) {
  SweepChange size;
  for (std::size_t k = 0; k < cells.count; ++k) {
    const double x = std::abs(scale * cells.step_x[k]);
    const double y = std::abs(scale * cells.step_y[k]);
    size.largest = std::max({size.largest, x, y});
    size.sum += x + y;
  }
  return size;
}

/// Of the direction with a step.
double curvature_with(std::size_t direction, const TractionColumns& cells, const PatchWork& work) {
  return dot(cells.count, work.pulled_x[direction].data(), work.pulled_y[direction].data(),
             cells.step_x, cells.step_y);
}

}  // namespace

Deflation find_deflation(const PatchProblem& problem, const TractionColumns& cells,
                         PatchWork& work) {
  Deflation deflation;
  for (std::size_t motion = 0; motion < kMotions; ++motion) {
    find_pull(problem, cells, motion, work);
    const double whole = curvature(cells);
    for (std::size_t k = 0; k < deflation.directions; ++k) {
      const double share = -curvature_with(k, cells, work);
      add_scaled(cells.count, share, work.pulls_x[k].data(), cells.step_x);
      add_scaled(cells.count, share, work.pulls_y[k].data(), cells.step_y);
      add_scaled(cells.count, share, work.pulled_x[k].data(), work.moves_x.data());
      add_scaled(cells.count, share, work.pulled_y[k].data(), work.moves_y.data());
    }
    const double left = curvature(cells);
    if (left <= kLeastLeft * whole) {
      continue;
    }
    const double scale = 1.0 / std::sqrt(left);
    const auto keep = [&](const double* from, std::vector<double>& to) {
      std::transform(from, from + cells.count, to.begin(),
                     [scale](double value) { return scale * value; });
    };
    keep(cells.step_x, work.pulls_x[deflation.directions]);
    keep(cells.step_y, work.pulls_y[deflation.directions]);
    keep(cells.moves_x, work.pulled_x[deflation.directions]);
    keep(cells.moves_y, work.pulled_y[deflation.directions]);
    deflation.sizes[deflation.directions] = size_of(cells, scale);
    ++deflation.directions;
  }
  std::fill_n(cells.step_x, cells.count, 0.0);
  std::fill_n(cells.step_y, cells.count, 0.0);
  return deflation;
}

void make_conjugate(const Deflation& deflation, const TractionColumns& cells,
                    const PatchWork& work) {
  for (std::size_t k = 0; k < deflation.directions; ++k) {
    const double share = -curvature_with(k, cells, work);
    add_scaled(cells.count, share, work.pulls_x[k].data(), cells.step_x);
    add_scaled(cells.count, share, work.pulls_y[k].data(), cells.step_y);
  }
}

SweepChange balance(const Deflation& deflation, const TractionColumns& cells,
                    const PatchWork& work) {
  SweepChange change;
  for (std::size_t k = 0; k < deflation.directions; ++k) {
    const double length = slope_along(cells, work.pulls_x[k].data(), work.pulls_y[k].data());
    add_scaled(cells.count, length, work.pulls_x[k].data(), cells.traction_x);
    add_scaled(cells.count, length, work.pulls_y[k].data(), cells.traction_y);
    add_scaled(cells.count, length, work.pulled_x[k].data(), cells.moved_x);
    add_scaled(cells.count, length, work.pulled_y[k].data(), cells.moved_y);
    change.largest += std::abs(length) * deflation.sizes[k].largest;
    change.sum += std::abs(length) * deflation.sizes[k].sum;
  }
  return change;
}

}  // namespace torsion
