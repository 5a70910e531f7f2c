#include "systems/hold/tool_hold.hpp"

#include <glm/geometric.hpp>

#include "systems/hold/tool_dynamics.hpp"
#include "systems/hold/tool_equilibrium.hpp"

namespace torsion {

Pose next_held_pose(const Model& model, const State& state, std::uint32_t tool, ToolHold hold,
                    const VirtualCoupling& coupling, const Pose& handle) {
  switch (hold) {
    case ToolHold::kMassless:
      return next_tool_pose(model, state, tool, coupling, handle);
    case ToolHold::kMass:
      return next_heavy_tool_pose(model, state, tool, coupling, handle);
    case ToolHold::kDirect:
      break;
  }
  return handle;
}

Wrench wrench_about_frame(const State& state, std::uint32_t tool) {
  const Wrench& total = state.tools.at<ToolWrench>(tool).total;
  const glm::dvec3 arm =
      state.tools.at<ToolMotion>(tool).mass_center - state.tools.at<ToolPose>(tool).now.position;
  return {total.force, total.torque + glm::cross(arm, total.force)};
}

Wrench felt_wrench(ToolHold hold, const VirtualCoupling& coupling, const Pose& handle,
                   const Pose& tool, const Wrench& contact) {
  if (hold == ToolHold::kDirect) {
    return {soft_limit(contact.force, coupling.largest_force),
            soft_limit(contact.torque, coupling.largest_torque)};
  }
  const Wrench pull = coupling_wrench(coupling, {handle}, {tool});
  return {-pull.force, -pull.torque};
}

}  // namespace torsion
