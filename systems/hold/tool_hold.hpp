#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ecs/state.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion {

/// How a handle holds a tool.
enum class ToolHold : std::uint32_t {
  kMassless,  // through the virtual coupling; the tool is where coupling and contacts balance
  kMass,      // through the virtual coupling; the tool has the scene's mass and inertia
  kDirect,    // the tool is where the handle is, and the hand feels the contacts themselves
};
inline constexpr std::array<std::string_view, 3> kToolHoldNames = {"massless", "mass", "direct"};

/// Where the tool goes next.
/// @param tool    row in `tools`; its pose and wrench are those of the last step
/// @param handle  pose that the handle asks of the tool's frame, world
Pose next_held_pose(const Model& model, const State& state, std::uint32_t tool, ToolHold hold,
                    const VirtualCoupling& coupling, const Pose& handle);

/// What the contacts do to the tool, about its frame's origin, world axes.
Wrench wrench_about_frame(const State& state, std::uint32_t tool);

/// What the hand is to feel, about the handle's origin, world axes: the coupling's spring, or held
/// directly the contacts, brought smoothly below the coupling's largest force and torque.
/// @param contact  wrench_about_frame of the step whose pose `tool` is
Wrench felt_wrench(ToolHold hold, const VirtualCoupling& coupling, const Pose& handle,
                   const Pose& tool, const Wrench& contact);

}  // namespace torsion
