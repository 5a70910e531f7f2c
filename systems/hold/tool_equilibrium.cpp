#include "systems/hold/tool_equilibrium.hpp"

#include <algorithm>

#include "systems/hold/tool_balance.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {
namespace {

/// How much of a step to take that follows `last`, 1/4 to 1. A contact that is stiffer than its
/// region's stiffness says (several regions on one body, meshes) throws each step past the balance
/// and the next one back: with steps that shrink by -g the balance is at the share 1 / (1 + g).
/// Source: Aitken's extrapolation, for the component along the last step in the metric of the
/// stiffness.
double share_of_step(const Matrix6& stiffness, const Vector6& last, const Vector6& step) {
  const Vector6 weighted = stiffness * last;
  const double square = last.dot(weighted);
  const double back = square > 0.0 ? -step.dot(weighted) / square : 0.0;
  constexpr double kMostBack = 3.0;
  return 1.0 / (1.0 + std::clamp(back, 0.0, kMostBack));
}

}  // namespace

Pose next_tool_pose(const Model& model, const State& state, std::uint32_t tool,
                    const VirtualCoupling& coupling, const Pose& handle) {
  const Pose& now = state.tools.at<ToolPose>(tool).now;
  const ToolBalance balance = balance_of(model, state, tool, coupling, handle);
  Vector6 step = solve_ldlt(balance.stiffness, balance.wrench);
  step *= share_of_step(balance.stiffness, last_motion(model, state, tool), step);
  if (!step.allFinite()) {
    return now;
  }
  const double share = safe_share(step, balance.touches);
  if (!balance.touches && share == 1.0) {
    return handle;
  }
  return moved(state, tool, share * step);
}

}  // namespace torsion
