#include "systems/held_tool/tool_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/contact_models/stuck_stiffness.hpp"
#include "systems/frames.hpp"
#include "systems/rotation_vector.hpp"

namespace torsion {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Of the way that the coupling is stretched: a step onto a contact that is not yet known must not
// throw the tool through it.
constexpr double kLongestStep = 1e-3;      // m
constexpr double kWidestTurn = 0.02;       // rad
constexpr double kLongestFreeStep = 5e-3;  // m: off every contact
constexpr double kWidestFreeTurn = 0.2;    // rad

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// Force and torque about a point for small motions of the point, of a spring at `arm` from it.
/// @param shifting, turning  N/m and N m/rad
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

/// Of one region that sticks, about the tool's mass centre.
Matrix6 contact_stiffness(const World& world, std::uint32_t region, const glm::dvec3& center) {
  const RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  const Pose& body = world.bodies.at<Pose>(world.regions.at<RegionIdentity>(region).body);
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const StuckStiffness stuck = stuck_stiffness(world, region, geometry.radius);
  const Eigen::Vector3d axis = eigen(body.rotation * frame.normal);
  const Eigen::Vector3d x = eigen(body.rotation * frame.tangent_x);
  const Eigen::Vector3d y = eigen(body.rotation * frame.tangent_y);
  const Eigen::Matrix3d normal = axis * axis.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal;
  const double along = world.regions.at<RegionNormal>(region).stiffness;
  return spring_about(to_outer(body, geometry.equivalent_point) - center,
                      along * normal + stuck.along_tangents * across,
                      stuck.about_normal * normal + stuck.about_tangents.x * (x * x.transpose()) +
                          stuck.about_tangents.y * (y * y.transpose()));
}

/// How much of a step to take that follows `last`, 1/4 to 1. A contact that is stiffer than its
/// region's stiffness says (several regions on one body, meshes) throws each step past the balance
/// and the next one back: with steps that shrink by -g the balance is at the share 1 / (1 + g).
/// Source: Aitken's extrapolation, for the component along the last step in the metric of the
/// stiffness.
double share_of_step(const Matrix6& stiffness, const Vector6& last, const Vector6& step) {
  const Vector6 weighted = stiffness * last;
  const double square = last.dot(weighted);
  const double back = square > 0.0 ? -step.dot(weighted) / square : 0.0;
  constexpr double kMostBack = 3.0;
  return 1.0 / (1.0 + std::clamp(back, 0.0, kMostBack));
}

/// Shift of the mass centre and turn over the last step.
Vector6 last_step(const World& world, std::uint32_t tool) {
  const ToolPose& pose = world.tools.at<ToolPose>(tool);
  const glm::dvec3& center = world.tools.at<MassProperties>(tool).center;
  Vector6 last;
  last << eigen(to_outer(pose.now, center) - to_outer(pose.before, center)),
      eigen(turn_between(pose.before.rotation, pose.now.rotation));
  return last;
}

/// What the contacts do to the tool as they are now. What is let out of a region lags behind while
/// it forms, merges or splits, and a tool without mass that fell through that lag would bounce.
Wrench contact_wrench(const World& world, std::uint32_t tool) {
  Wrench contact = world.tools.at<ToolWrench>(tool).total;
  if (world.tools.at<ToolWrench>(tool).state != WrenchState::kLive) {
    return contact;
  }
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (world.regions.at<RegionIdentity>(region).tool == tool) {
      const RegionWrench& wrench = world.regions.at<RegionWrench>(region);
      contact.force -= wrench.event_share * wrench.event_change.force;
      contact.torque -= wrench.event_share * wrench.event_change.torque;
    }
  }
  return contact;
}

}  // namespace

Pose next_tool_pose(const World& world, std::uint32_t tool, const VirtualCoupling& coupling,
                    const Pose& handle) {
  const Pose& now = world.tools.at<ToolPose>(tool).now;
  const glm::dvec3 center = world.tools.at<ToolMotion>(tool).mass_center;
  const Wrench contact = contact_wrench(world, tool);
  const Wrench pull = coupling_wrench(coupling, {handle}, {now});
  const glm::dvec3 arm = now.position - center;

  Matrix6 stiffness = spring_about(arm, coupling.stiffness * Eigen::Matrix3d::Identity(),
                                   coupling.turn_stiffness * Eigen::Matrix3d::Identity());
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (world.regions.at<RegionIdentity>(region).tool == tool) {
      stiffness += contact_stiffness(world, region, center);
    }
  }
  Vector6 wrench;
  wrench << eigen(pull.force + contact.force),
      eigen(pull.torque + glm::cross(arm, pull.force) + contact.torque);
  Vector6 step = stiffness.ldlt().solve(wrench);
  step *= share_of_step(stiffness, last_step(world, tool), step);
  glm::dvec3 shift(step[0], step[1], step[2]);
  glm::dvec3 turn(step[3], step[4], step[5]);
  const double length = glm::length(shift);
  const double angle = glm::length(turn);
  if (!std::isfinite(length + angle)) {
    return now;
  }
  const bool touches = contact.force != glm::dvec3(0.0) || contact.torque != glm::dvec3(0.0);
  const double longest = touches ? kLongestStep : kLongestFreeStep;
  const double widest = touches ? kWidestTurn : kWidestFreeTurn;
  const double share =
      std::min(longest / std::max(length, longest), widest / std::max(angle, widest));
  if (!touches && share == 1.0) {
    return handle;
  }
  shift *= share;
  turn *= share;
  Pose next = now;
  const double used = glm::length(turn);
  const glm::dquat rotation =
      used > 0.0 ? glm::angleAxis(used, turn / used) : glm::dquat(1.0, 0.0, 0.0, 0.0);
  next.rotation = glm::normalize(rotation * now.rotation);
  next.position = center + shift + rotation * arm;
  return next;
}

}  // namespace torsion
