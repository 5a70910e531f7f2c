#include "systems/hold/virtual_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <glm/geometric.hpp>

namespace torsion::engine {
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
  const glm::dvec3 chord = 2.0 * glm::dvec3(turn.x, turn.y, turn.z);
  const glm::dvec3 torque =
      coupling.turn_stiffness * chord +
      coupling.turn_damping * (handle.angular_velocity - tool.angular_velocity);
  return {soft_limit(pull, coupling.largest_force), soft_limit(torque, coupling.largest_torque)};
}

namespace {

constexpr double kBalanceShare = 0.9;  // of its largest, with which a coupling balances at most

/// The inverse of soft_limit(), up to nine tenths of `most`.
glm::dvec3 before_limit(const glm::dvec3& vector, double most) {
  const double length = glm::length(vector);
  if (!(length > 0.0) || !(most > 0.0)) {
    return glm::dvec3(0.0);
  }
  const double share = std::min(length / most, kBalanceShare);
  return vector / length * (share * most / std::sqrt(1.0 - share * share));
}

}  // namespace

Pose balancing_handle(const VirtualCoupling& coupling, const Pose& tool, const Wrench& contact) {
  Pose handle = tool;
  if (coupling.stiffness > 0.0) {
    handle.position -= before_limit(contact.force, coupling.largest_force) / coupling.stiffness;
  }
  if (coupling.turn_stiffness > 0.0) {
    const glm::dvec3 chord =
        -before_limit(contact.torque, coupling.largest_torque) / coupling.turn_stiffness;
    const double length = glm::length(chord);
    const double half_sine = std::min(0.5 * length, 1.0);
    if (length > 0.0) {
      handle.rotation = glm::normalize(glm::angleAxis(2.0 * std::asin(half_sine), chord / length) *
                                       tool.rotation);
    }
  }
  return handle;
}

VirtualCoupling strong_enough(const VirtualCoupling& coupling, const Wrench& contact) {
  VirtualCoupling stronger = coupling;
  stronger.largest_force =
      std::max(coupling.largest_force, glm::length(contact.force) / kBalanceShare);
  stronger.largest_torque =
      std::max(coupling.largest_torque, glm::length(contact.torque) / kBalanceShare);
  // A spring in turning has its largest torque at a half turn: it is to answer at a sixth or less.
  stronger.turn_stiffness = std::max(
      coupling.turn_stiffness, glm::length(before_limit(contact.torque, stronger.largest_torque)));
  return stronger;
}

namespace {

constexpr double kStabilityMargin = 0.9;
constexpr double kCautious = 500.0;      // N/m: soft enough for any device that is sold
constexpr double kCautiousTurn = 0.5;    // N m/rad
constexpr double kCautiousForce = 3.0;   // N
constexpr double kCautiousTorque = 0.1;  // N m

std::pair<double, StiffnessLimit> stiffness_for(double damping, double hold, double largest,
                                                double cautious) {
  const double passive = kStabilityMargin * damping / hold;
  if (damping > 0.0 && (largest <= 0.0 || passive < largest)) {
    return {passive, StiffnessLimit::kPassivity};
  }
  return largest > 0.0 ? std::pair(largest, StiffnessLimit::kDevice)
                       : std::pair(cautious, StiffnessLimit::kUnknown);
}

}  // namespace

const char* limit_text(StiffnessLimit limit) {
  switch (limit) {
    case StiffnessLimit::kPassivity:
      return "0.9 b / (T / 2 + t_d), so that it stays passive";
    case StiffnessLimit::kDevice:
      return "the device's largest";
    default:
      return "cautious, as the device's damping and limits are not known";
  }
}

double virtual_coupling_bound(double damping, double period) {
  return 2.0 * std::numbers::pi * damping / period;
}

CouplingChoice choose_coupling(const DeviceTraits& device) {
  const double hold = 0.5 * device.period + device.delay;
  CouplingChoice choice;
  std::tie(choice.coupling.stiffness, choice.limit) =
      stiffness_for(device.damping, hold, device.largest_stiffness, kCautious);
  std::tie(choice.coupling.turn_stiffness, choice.turn_limit) =
      stiffness_for(device.turn_damping, hold, device.largest_turn_stiffness, kCautiousTurn);
  choice.coupling.largest_force =
      device.largest_force > 0.0 ? device.largest_force : kCautiousForce;
  // A tool on a device without torque output is still turned by it, and needs a torque that turns
  // it.
  choice.coupling.largest_torque =
      device.largest_torque > 0.0 ? device.largest_torque : kCautiousTorque;
  return choice;
}

}  // namespace torsion::engine
