#pragma once

#include <cstdint>

#include "ecs/state.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion {

/// What slows a tool with mass down, against the world.
struct ToolDamping {
  double translation = 0.0;  // N s/m
  double rotation = 0.0;     // N m s/rad
};

/// A tenth of what would be critical for the tool on the coupling's springs, 2 sqrt(K m) and
/// 2 sqrt(k I) with the mean moment of inertia. It acts against the world: between handle and tool
/// the hand would have to feel it, which a device of less damping cannot display, and a damper that
/// only the tool feels feeds an oscillation (0.2 J in seconds with a hand of 50 N/m).
ToolDamping choose_damping(const VirtualCoupling& coupling, const MassProperties& mass);

/// Where a tool with the scene's mass and inertia goes next: one step of backward Euler, linearised
/// about where it is with the stiffness of coupling and contacts that stick, so that no stiffness
/// makes it unstable. Its velocity is that of the last step. Gravity does not act. Allocates
/// nothing. Source: Otaduy & Lin, 2006.
/// @param tool    row in `tools`; its pose and wrench are those of the last step
/// @param handle  pose that the handle asks of the tool's frame, world
Pose next_heavy_tool_pose(const Model& model, const State& state, std::uint32_t tool,
                          const VirtualCoupling& coupling, const Pose& handle);

}  // namespace torsion
