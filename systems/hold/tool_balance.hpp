#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "ecs/state.hpp"
#include "systems/hold/virtual_coupling.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {

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

}  // namespace torsion
