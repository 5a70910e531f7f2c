#include "systems/hold/tool_balance.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "systems/contact/stuck_stiffness.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/rotation_vector.hpp"

namespace torsion {
namespace {

constexpr double kLongestStep = 1e-3;      // m
constexpr double kWidestTurn = 0.02;       // rad
constexpr double kLongestFreeStep = 5e-3;  // m: off every contact
constexpr double kWidestFreeTurn = 0.2;    // rad

/// Of one region that sticks, about the tool's mass centre.
Matrix6 contact_stiffness(const Model& model, const State& state, std::uint32_t region,
                          const glm::dvec3& center) {
  const Contact& contact = state.regions.at<Contact>(region);
  const Pose& body = model.bodies.at<Pose>(state.regions.at<RegionIdentity>(region).body);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const StuckStiffness stuck = stuck_stiffness(model, state, region, contact.radius);
  const Eigen::Vector3d axis = eigen(body.rotation * frame.normal);
  const Eigen::Vector3d x = eigen(body.rotation * frame.tangent_x);
  const Eigen::Vector3d y = eigen(body.rotation * frame.tangent_y);
  const Eigen::Matrix3d normal = axis * axis.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal;
  const double along = state.regions.at<RegionNormal>(region).stiffness;
  return spring_about(to_outer(body, contact.equivalent_point) - center,
                      along * normal + stuck.along_tangents * across,
                      stuck.about_normal * normal + stuck.about_tangents.x * (x * x.transpose()) +
                          stuck.about_tangents.y * (y * y.transpose()));
}

/// What the contacts do to the tool as they are now. What is let out of a region lags behind while
/// it forms, merges or splits, and a tool without mass that fell through that lag would bounce.
Wrench contact_wrench(const State& state, std::uint32_t tool) {
  Wrench contact = state.tools.at<ToolWrench>(tool).total;
  if (state.tools.at<ToolWrench>(tool).state != WrenchState::kLive) {
    return contact;
  }
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (state.regions.at<RegionIdentity>(region).tool == tool) {
      const RegionWrench& wrench = state.regions.at<RegionWrench>(region);
      contact.force -= wrench.event_share * wrench.event_change.force;
      contact.torque -= wrench.event_share * wrench.event_change.torque;
    }
  }
  return contact;
}

}  // namespace

Matrix6 spring_about(const glm::dvec3& arm, const Eigen::Matrix3d& shifting,
                     const Eigen::Matrix3d& turning) {
  Eigen::Matrix3d lever;
  lever << 0.0, -arm.z, arm.y, arm.z, 0.0, -arm.x, -arm.y, arm.x, 0.0;
  Eigen::Matrix<double, 3, 6> at_arm;
  at_arm << Eigen::Matrix3d::Identity(), -lever;
  Matrix6 stiffness = at_arm.transpose() * shifting * at_arm;
  stiffness.bottomRightCorner<3, 3>() += turning;
  return stiffness;
}

ToolBalance balance_of(const Model& model, const State& state, std::uint32_t tool,
                       const VirtualCoupling& coupling, const Pose& handle) {
  const Pose& now = state.tools.at<ToolPose>(tool).now;
  const glm::dvec3 center = state.tools.at<ToolMotion>(tool).mass_center;
  const Wrench contact = contact_wrench(state, tool);
  const Wrench pull = coupling_wrench(coupling, {handle}, {now});
  const glm::dvec3 arm = now.position - center;
  ToolBalance balance;
  balance.touches = contact.force != glm::dvec3(0.0) || contact.torque != glm::dvec3(0.0);
  balance.stiffness = spring_about(arm, coupling.stiffness * Eigen::Matrix3d::Identity(),
                                   coupling.turn_stiffness * Eigen::Matrix3d::Identity());
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (state.regions.at<RegionIdentity>(region).tool == tool) {
      balance.stiffness += contact_stiffness(model, state, region, center);
    }
  }
  balance.wrench << eigen(pull.force + contact.force),
      eigen(pull.torque + glm::cross(arm, pull.force) + contact.torque);
  return balance;
}

Vector6 last_motion(const Model& model, const State& state, std::uint32_t tool) {
  if (state.clock.step < 2) {
    return Vector6::Zero();
  }
  const ToolPose& pose = state.tools.at<ToolPose>(tool);
  const glm::dvec3& center = model.tools.at<MassProperties>(tool).center;
  Vector6 last;
  last << eigen(to_outer(pose.now, center) - to_outer(pose.before, center)),
      eigen(turn_between(pose.before.rotation, pose.now.rotation));
  return last;
}

double safe_share(const Vector6& motion, bool touches) {
  const double longest = touches ? kLongestStep : kLongestFreeStep;
  const double widest = touches ? kWidestTurn : kWidestFreeTurn;
  return std::min(longest / std::max(motion.head<3>().norm(), longest),
                  widest / std::max(motion.tail<3>().norm(), widest));
}

Pose moved(const State& state, std::uint32_t tool, const Vector6& motion) {
  const Pose& now = state.tools.at<ToolPose>(tool).now;
  const glm::dvec3 center = state.tools.at<ToolMotion>(tool).mass_center;
  const glm::dvec3 shift(motion[0], motion[1], motion[2]);
  const glm::dvec3 turn(motion[3], motion[4], motion[5]);
  const double angle = glm::length(turn);
  const glm::dquat rotation =
      angle > 0.0 ? glm::angleAxis(angle, turn / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
  return {center + shift + rotation * (now.position - center),
          glm::normalize(rotation * now.rotation)};
}

}  // namespace torsion
