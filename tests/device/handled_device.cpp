#include "tests/device/handled_device.hpp"

#include <numbers>

#include "device/drivers/wooden_driver.hpp"
#include "device/protocols/falcon_kinematics.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kStep = 1e-6;  // m, rad: of differences
const glm::dvec3 kFalconCentre(0.0, 0.0, 0.115);

/// rad, to the left: about the axis that comes to who holds it.
double angle_of(const MovingFrame& handle) {
  return turn_between(glm::dquat(1.0, 0.0, 0.0, 0.0), handle.pose.rotation).y;
}

/// A Falcon's force by virtual work: torque times the turn of each joint is force times way. A
/// motor value of -10000 is one newton metre (libnifalcon's scale).
glm::dvec3 falcon_push(const EmulatedFalcon& falcon, const glm::dvec3& place,
                       const std::array<double, 3>& signs) {
  const auto here = falcon_inverse(place);
  glm::dvec3 force(0.0);
  for (glm::length_t axis = 0; axis < 3 && here; ++axis) {
    glm::dvec3 aside = place;
    aside[axis] += kStep;
    const auto there = falcon_inverse(aside);
    for (glm::length_t leg = 0; leg < 3 && there; ++leg) {
      const auto motor = static_cast<std::size_t>(leg);
      const double torque = signs[motor] * falcon.motors[motor] / -10000.0;
      force[axis] += torque * ((*there)[leg] - (*here)[leg]) / kStep;
    }
  }
  return force;
}

}  // namespace

HandledDevice::HandledDevice(const HandTraits& hand, const Miswiring& wrong, std::uint32_t seed)
    : wrong_(wrong), hand_(hand, {}, seed), arm_(wrong.home) {
  arm_.motors = wrong.motors;
  arm_.encoders = wrong.encoders;
}

Wrench HandledDevice::push_of(const EmulatedDevice& device) const {
  Wrench push;
  if (const auto* const falcon = std::get_if<EmulatedFalcon>(&device)) {
    push.force = falcon_push(*falcon, kFalconCentre + wrong_.home + hand_.state().pose.position,
                             wrong_.motors);
  } else if (const auto* const wooden = std::get_if<EmulatedWooden>(&device)) {
    push.force = wooden_to_world(test::push_of(arm_, *wooden));
  } else if (const auto* const odrive = std::get_if<EmulatedOdrive>(&device)) {
    push.torque.y = odrive->closed_loop ? wrong_.motors[0] * odrive->torque : 0.0;
  } else if (const auto* const moteus = std::get_if<EmulatedMoteus>(&device)) {
    push.torque.y = wrong_.motors[0] * moteus->torque;
  } else if (const auto* const wheel = std::get_if<EmulatedWheel>(&device)) {
    push.torque.y = wrong_.motors[0] * torque_of(*wheel);
  }
  return {wrong_.strength * push.force, wrong_.strength * push.torque};
}

void HandledDevice::count(EmulatedDevice& device, const glm::dvec3& way) {
  const double turns = wrong_.encoders[0] * angle_of(hand_.state()) / kTurn;
  if (auto* const falcon = std::get_if<EmulatedFalcon>(&device)) {
    falcon->place = kFalconCentre + hand_.state().pose.position;  // it counts from where it was
  } else if (auto* const wooden = std::get_if<EmulatedWooden>(&device)) {
    move_by(arm_, *wooden, world_to_wooden(way));
  } else if (auto* const odrive = std::get_if<EmulatedOdrive>(&device)) {
    odrive->turns = turns;
  } else if (auto* const moteus = std::get_if<EmulatedMoteus>(&device)) {
    moteus->turns = turns;
  } else if (auto* const wheel = std::get_if<EmulatedWheel>(&device)) {
    wheel->turn = -kTurn * turns;
  }
}

void HandledDevice::move(EmulatedDevice& device, const Pose& wanted, double period) {
  const glm::dvec3 before = hand_.state().pose.position;
  hand_.move(push_of(device), wanted, period);
  count(device, hand_.state().pose.position - before);
}

}  // namespace torsion::engine::test
