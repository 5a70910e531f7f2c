#include "systems/paper/brush.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact/stick_slip.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

constexpr double kNoLoad = 1e-300;  // Pa: keeps 0 / 0 away

/// The elastic trial, and the friction limit.
TORSION_WIDEST
void try_elastic(const BrushState& brush, BrushBlock& __restrict block) {
  const BrushState state = brush;
  const double slide_x = state.translation_stiffness * state.slide.x;
  const double slide_y = state.translation_stiffness * state.slide.y;
  const double fall = state.friction.static_friction - state.friction.dynamic_friction;
  for (std::size_t i = 0; i < kBrushBlock; ++i) {
    const double lever = std::abs(state.lever_origin + (state.lever_slope.x * block.x[i] +
                                                        state.lever_slope.y * block.y[i] +
                                                        state.lever_slope.z * block.height[i]));
    const double stiffness = state.shear_modulus / larger(lever, state.least_lever);
    const double turned_x = -state.spin * (block.y[i] - state.pivot.y);
    const double turned_y = state.spin * (block.x[i] - state.pivot.x);
    const double trial_x = block.traction_x[i] - slide_x - stiffness * turned_x;
    const double trial_y = block.traction_y[i] - slide_y - stiffness * turned_y;
    const double kinetic = larger(block.kinetic_share[i], state.kinetic_share);
    block.twist_stiffness[i] = stiffness;
    block.limit[i] = state.pressure * (state.friction.static_friction - kinetic * fall);
    block.elastic_x[i] = trial_x;
    block.elastic_y[i] = trial_y;
    block.trial_size[i] = std::sqrt(trial_x * trial_x + trial_y * trial_y);
  }
}

/// mu_s falls to mu_d as a cell slips, and recovers once the cell has been loaded in the opposite
/// direction by the same distance.
TORSION_WIDEST
void fall_and_recover(const BrushState& brush, BrushBlock& __restrict block) {
  const double inverse_limit = brush.inverse_limit;
  for (std::size_t i = 0; i < kBrushBlock; ++i) {
    const double past = block.trial_size[i] - block.limit[i];
    const double change_x = block.elastic_x[i] - block.traction_x[i];
    const double change_y = block.elastic_y[i] - block.traction_y[i];
    const double path = past > 0.0 ? past : std::sqrt(change_x * change_x + change_y * change_y);
    const double way = travelled(path, past > 0.0 ? inverse_limit / kSlipLength : inverse_limit);
    const double share = block.kinetic_share[i];
    block.kinetic_share[i] = share + way * (past > 0.0 ? 1.0 - share : -share);
  }
}

/// Caps the trials at the limit.
TORSION_WIDEST
void cap(const BrushState& brush, BrushBlock& __restrict block) {
  const double may_stick = brush.kinetic_share < 0.5 ? 1.0 : 0.0;
  for (std::size_t i = 0; i < kBrushBlock; ++i) {
    const double limit = block.limit[i];
    const double kept = limit / larger(larger(limit, block.trial_size[i]), kNoLoad);
    const double elastic_x = kept * block.elastic_x[i];
    const double elastic_y = kept * block.elastic_y[i];
    block.cut_x[i] = block.area[i] * (block.elastic_x[i] - elastic_x);
    block.cut_y[i] = block.area[i] * (block.elastic_y[i] - elastic_y);
    block.elastic_x[i] = elastic_x;
    block.elastic_y[i] = elastic_y;
    block.sticks[i] = block.trial_size[i] > limit ? 0.0 : may_stick;
  }
}

/// The kinetic branch: the share of the region that slides goes to the limit against the cell's own
/// motion, by the share travelled(moved) of the distance, and never beyond the limit.
TORSION_WIDEST
void slide_on(const BrushState& brush, BrushBlock& __restrict block) {
  const BrushState state = brush;
  for (std::size_t i = 0; i < kBrushBlock; ++i) {
    const double motion_x = state.slide.x - state.spin * (block.y[i] - state.pivot.y);
    const double motion_y = state.slide.y + state.spin * (block.x[i] - state.pivot.x);
    const double moved = std::sqrt(motion_x * motion_x + motion_y * motion_y);
    const double limit = block.limit[i];
    // travelled(moved) / moved, times 1 + moved * grown
    const double grown =
        growth(moved * state.inverse_slip_displacement) * state.inverse_slip_displacement;
    const double way_x = block.traction_x[i] - limit * grown * motion_x;
    const double way_y = block.traction_y[i] - limit * grown * motion_y;
    const double size = std::sqrt(way_x * way_x + way_y * way_y);
    const double kept = limit / larger(larger(limit * (1.0 + moved * grown), size), kNoLoad);
    block.moved[i] = block.area[i] > 0.0 ? moved : 0.0;
    block.elastic_x[i] += state.kinetic_share * (kept * way_x - block.elastic_x[i]);
    block.elastic_y[i] += state.kinetic_share * (kept * way_y - block.elastic_y[i]);
  }
}

TORSION_WIDEST
void add_up(const BrushState& brush, const BrushBlock& __restrict block,
            BrushLanes& __restrict lanes) {
  const BrushState state = brush;
  for (std::size_t first = 0; first < kBrushBlock; first += lanes.area.size()) {
    for (std::size_t lane = 0; lane < lanes.area.size(); ++lane) {
      const std::size_t i = first + lane;
      const double area = block.area[i];
      const double force_x = area * block.traction_x[i];
      const double force_y = area * block.traction_y[i];
      const double turning_x = block.x[i] - state.pivot.x;
      const double turning_y = block.y[i] - state.pivot.y;
      const double stuck = block.sticks[i];
      lanes.area[lane] += area;
      lanes.force_x[lane] += force_x;
      lanes.force_y[lane] += force_y;
      lanes.couple[lane] +=
          (block.x[i] - state.center.x) * force_y - (block.y[i] - state.center.y) * force_x;
      lanes.cut_x[lane] += block.cut_x[i];
      lanes.cut_y[lane] += block.cut_y[i];
      lanes.moved[lane] = larger(block.moved[i], lanes.moved[lane]);
      lanes.stuck_area[lane] += stuck * area;
      lanes.stuck_couple[lane] += stuck * (turning_x * force_y - turning_y * force_x);
      lanes.stuck_stiffness[lane] +=
          stuck * area * block.twist_stiffness[i] * (turning_x * turning_x + turning_y * turning_y);
    }
  }
}

}  // namespace

void update_brushes(const BrushState& brush, BrushBlock& block, BrushLanes& lanes) {
  try_elastic(brush, block);
  if (brush.falls) {
    fall_and_recover(brush, block);
  }
  cap(brush, block);
  block.moved.fill(0.0);
  if (brush.kinetic_share > 0.0 || brush.several) {
    slide_on(brush, block);
  }
  block.traction_x = block.elastic_x;
  block.traction_y = block.elastic_y;
  add_up(brush, block, lanes);
}

BrushSums total(const BrushLanes& lanes) {
  BrushSums sums;
  sums.area = sum_of(lanes.area);
  sums.stuck_area = sum_of(lanes.stuck_area);
  sums.force = {sum_of(lanes.force_x), sum_of(lanes.force_y)};
  sums.couple = sum_of(lanes.couple);
  sums.cut = {sum_of(lanes.cut_x), sum_of(lanes.cut_y)};
  sums.moved = *std::ranges::max_element(lanes.moved);
  sums.stuck_couple = sum_of(lanes.stuck_couple);
  sums.stuck_stiffness = sum_of(lanes.stuck_stiffness);
  return sums;
}

}  // namespace torsion::engine
