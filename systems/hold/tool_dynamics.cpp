#include "systems/hold/tool_dynamics.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "systems/hold/tool_balance.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {
namespace {

/// Moments of inertia about the mass centre, world axes, kg m^2.
glm::dmat3 world_inertia(const Model& model, const State& state, std::uint32_t tool) {
  const glm::dmat3 to_world = glm::mat3_cast(state.tools.at<ToolPose>(tool).now.rotation);
  return to_world * model.tools.at<MassProperties>(tool).inertia * glm::transpose(to_world);
}

}  // namespace

ToolDamping choose_damping(const VirtualCoupling& coupling, const MassProperties& mass) {
  constexpr double kOfCritical = 0.1;
  const double inertia = (mass.inertia[0][0] + mass.inertia[1][1] + mass.inertia[2][2]) / 3.0;
  return {kOfCritical * 2.0 * std::sqrt(coupling.stiffness * mass.mass),
          kOfCritical * 2.0 * std::sqrt(coupling.turn_stiffness * inertia)};
}

Pose next_heavy_tool_pose(const Model& model, const State& state, std::uint32_t tool,
                          const VirtualCoupling& coupling, const Pose& handle) {
  const MassProperties& properties = model.tools.at<MassProperties>(tool);
  const double h = state.clock.dt;
  const ToolBalance balance = balance_of(model, state, tool, coupling, handle);
  const Vector6 velocity = last_motion(model, state, tool) / h;
  const ToolDamping tool_damping = choose_damping(coupling, properties);
  const glm::dmat3 inertia = world_inertia(model, state, tool);
  Matrix6 mass = Matrix6::Zero();
  mass.topLeftCorner<3, 3>() = properties.mass * Eigen::Matrix3d::Identity();
  for (int column = 0; column < 3; ++column) {
    mass.block<3, 1>(3, 3 + column) = eigen(inertia[column]);
  }
  Vector6 damping;
  damping << Eigen::Vector3d::Constant(tool_damping.translation),
      Eigen::Vector3d::Constant(tool_damping.rotation);
  const glm::dvec3 turning(velocity[3], velocity[4], velocity[5]);
  Vector6 wrench = balance.wrench;
  wrench.tail<3>() -= eigen(glm::cross(turning, inertia * turning));
  // M (v' - v) / h = W - D v' - h K v'
  Matrix6 system = mass / h + h * balance.stiffness;
  system.diagonal() += damping;
  const Vector6 motion = h * solve_ldlt(system, mass / h * velocity + wrench);
  if (!motion.allFinite()) {
    return state.tools.at<ToolPose>(tool).now;
  }
  return moved(state, tool, safe_share(motion, balance.touches) * motion);
}

}  // namespace torsion
