#include "systems/hold/tool_hold.hpp"

#include <glm/geometric.hpp>

#include "systems/hold/tool_dynamics.hpp"
#include "systems/hold/tool_equilibrium.hpp"

namespace torsion {

Pose next_held_pose(const World& world, std::uint32_t tool, ToolHold hold,
                    const VirtualCoupling& coupling, const Pose& handle) {
  switch (hold) {
    case ToolHold::kMassless:
      return next_tool_pose(world, tool, coupling, handle);
    case ToolHold::kMass:
      return next_heavy_tool_pose(world, tool, coupling, handle);
    case ToolHold::kDirect:
      break;
  }
  return handle;
}

Wrench wrench_about_frame(const World& world, std::uint32_t tool) {
  const Wrench& total = world.tools.at<ToolWrench>(tool).total;
  const glm::dvec3 arm =
      world.tools.at<ToolMotion>(tool).mass_center - world.tools.at<ToolPose>(tool).now.position;
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
