#include "systems/hold/tool_hold.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "systems/contact/stick_slip.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
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
  const double h = model.dt;
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

namespace {

constexpr double kLongestStep = 1e-3;      // m
constexpr double kWidestTurn = 0.02;       // rad
constexpr double kLongestFreeStep = 5e-3;  // m: off every contact
constexpr double kWidestFreeTurn = 0.2;    // rad

/// Stiffness of one region that sticks, about the tool's mass centre.
Matrix6 contact_stiffness(const Model& model, const State& state, std::uint32_t region,
                          const glm::dvec3& center) {
  const Contact& contact = state.regions.at<Contact>(region);
  const Pose& body = state.bodies.at<BodyPose>(state.regions.at<RegionIdentity>(region).body).now;
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

/// The present wrench of the contacts on the tool. A region's output lags behind while it forms,
/// joins or splits: a tool without mass would fall through that lag and bounce.
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
  const glm::dquat rotation = rotation_by({motion[3], motion[4], motion[5]});
  return {center + shift + rotation * (now.position - center),
          glm::normalize(rotation * now.rotation)};
}

namespace {

/// How much of a step that follows `last` is taken, 1/4 to 1. A contact that is stiffer than its
/// region's stiffness says (several regions on one body, meshes) makes each step overshoot the
/// balance: with steps that change by the factor -g the balance lies at the share 1 / (1 + g).
/// Source: Aitken's extrapolation, for the component along the last step in the metric of the
/// stiffness.
double share_of_step(const Matrix6& stiffness, const Vector6& last, const Vector6& step) {
  const Vector6 weighted = stiffness * last;
  const double square = last.dot(weighted);
  const double back = square > 0.0 ? -step.dot(weighted) / square : 0.0;
  constexpr double kMostBack = 3.0;
  return 1.0 / (1.0 + std::clamp(back, 0.0, kMostBack));
}

}  // namespace

Pose next_tool_pose(const Model& model, const State& state, std::uint32_t tool,
                    const VirtualCoupling& coupling, const Pose& handle) {
  const Pose& now = state.tools.at<ToolPose>(tool).now;
  const ToolBalance balance = balance_of(model, state, tool, coupling, handle);
  Vector6 step = solve_ldlt(balance.stiffness, balance.wrench);
  step *= share_of_step(balance.stiffness, last_motion(model, state, tool), step);
  if (!step.allFinite()) {
    return now;
  }
  const double share = safe_share(step, balance.touches);
  if (!balance.touches && share == 1.0) {
    return handle;
  }
  return moved(state, tool, share * step);
}

Pose next_held_pose(const Model& model, const State& state, std::uint32_t tool, ToolHold hold,
                    const VirtualCoupling& coupling, const Pose& handle) {
  switch (hold) {
    case ToolHold::kMassless:
      return next_tool_pose(model, state, tool, coupling, handle);
    case ToolHold::kMass:
      return next_heavy_tool_pose(model, state, tool, coupling, handle);
    case ToolHold::kDirect:
      break;
  }
  return handle;
}

Wrench wrench_about_frame(const State& state, std::uint32_t tool) {
  const Wrench& total = state.tools.at<ToolWrench>(tool).total;
  const glm::dvec3 arm =
      state.tools.at<ToolMotion>(tool).mass_center - state.tools.at<ToolPose>(tool).now.position;
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

}  // namespace torsion::engine
