#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "ecs/state.hpp"
#include "systems/hold/virtual_coupling.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {

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

/// What acts on a held tool where it is, about its mass centre, world axes: forces and torques
/// (N, N m) to first order in small shifts and turns of the tool (m, rad).
struct ToolBalance {
  Vector6 wrench;     // of coupling and contacts
  Matrix6 stiffness;  // of both, contacts as they stick
  bool touches = false;
};

/// Force and torque about a point for small motions of the point, of a spring at `arm` from it.
/// @param shifting, turning  N/m and N m/rad
Matrix6 spring_about(const glm::dvec3& arm, const Eigen::Matrix3d& shifting,
                     const Eigen::Matrix3d& turning);

/// @param tool    row in `tools`; its pose and wrench are those of the last step
/// @param handle  pose that the handle asks of the tool's frame, world
ToolBalance balance_of(const Model& model, const State& state, std::uint32_t tool,
                       const VirtualCoupling& coupling, const Pose& handle);

/// How the tool moved over the last step: shift of its mass centre (m) and turn (rad). In the first
/// step it did not move, it was put there.
Vector6 last_motion(const Model& model, const State& state, std::uint32_t tool);

/// Of a motion of the tool the share that may be taken in one step: a step onto a contact that is
/// not yet known must not throw the tool through it.
double safe_share(const Vector6& motion, bool touches);

/// The tool's frame after a shift of its mass centre and a turn about it.
Pose moved(const State& state, std::uint32_t tool, const Vector6& motion);

/// Where a tool without mass goes next: one Newton step towards the pose in which the coupling's
/// pull and the contact's push balance, with the stiffness of coupling and contacts that stick.
/// Allocates nothing. Source: quasi-static tools after Barbic & James, 2008.
/// @param tool    row in `tools`; its pose and wrench are those of the last step
/// @param handle  pose that the handle asks of the tool's frame, world
/// @return the tool's pose for the next step
Pose next_tool_pose(const Model& model, const State& state, std::uint32_t tool,
                    const VirtualCoupling& coupling, const Pose& handle);

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

}  // namespace torsion::engine
