#include "systems/hold/virtual_coupling.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace torsion {

glm::dvec3 soft_limit(const glm::dvec3& vector, double most) {
  if (!(most > 0.0)) {
    return glm::dvec3(0.0);
  }
  const double share = glm::length(vector) / most;
  return vector / std::sqrt(1.0 + share * share);
}

Wrench coupling_wrench(const VirtualCoupling& coupling, const MovingFrame& handle,
                       const MovingFrame& tool) {
  const glm::dvec3 pull = coupling.stiffness * (handle.pose.position - tool.pose.position) +
                          coupling.damping * (handle.velocity - tool.velocity);
  glm::dquat turn = handle.pose.rotation * glm::conjugate(tool.pose.rotation);
  turn = turn.w < 0.0 ? -turn : turn;
  // 2 sin(theta / 2) n
  const glm::dvec3 twist = 2.0 * glm::dvec3(turn.x, turn.y, turn.z);
  const glm::dvec3 torque =
      coupling.turn_stiffness * twist +
      coupling.turn_damping * (handle.angular_velocity - tool.angular_velocity);
  return {soft_limit(pull, coupling.largest_force), soft_limit(torque, coupling.largest_torque)};
}

}  // namespace torsion
