#pragma once

#include <cstdint>

#include "ecs/state.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion {

/// Where a tool without mass goes next: one Newton step towards the pose in which the coupling's
/// pull and the contact's push balance, with the stiffness of coupling and contacts that stick.
/// Allocates nothing. Source: quasi-static tools after Barbic & James, 2008.
/// @param tool    row in `tools`; its pose and wrench are those of the last step
/// @param handle  pose that the handle asks of the tool's frame, world
/// @return the tool's pose for the next step
Pose next_tool_pose(const Model& model, const State& state, std::uint32_t tool,
                    const VirtualCoupling& coupling, const Pose& handle);

}  // namespace torsion
