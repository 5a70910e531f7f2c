#include "systems/hold/coupling_choice.hpp"

#include <numbers>
#include <tuple>

namespace torsion {
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
  // A tool on a device without torque is still turned by it, and needs something to turn it.
  choice.coupling.largest_torque =
      device.largest_torque > 0.0 ? device.largest_torque : kCautiousTorque;
  return choice;
}

}  // namespace torsion
