#include "tests/systems/hold/emulated_hand.hpp"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"
namespace torsion::engine::test {
namespace {

glm::dvec3 counted(const glm::dvec3& value, double step) {
  return step > 0.0 ? glm::round(value / step) * step : value;
}

glm::dvec3 at_most(const glm::dvec3& vector, double most) {
  const double length = glm::length(vector);
  return length > most ? vector * (most / length) : vector;
}

glm::dquat quaternion(const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  return angle > 0.0 ? glm::angleAxis(angle, turn / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

}  // namespace

HandTraits random_hand(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto spread = [&](double low, double high) {
    return low * std::pow(high / low, between(0.0, 1.0));
  };
  HandTraits hand;
  hand.mass = spread(0.05, 0.6);
  hand.grip_stiffness = spread(50.0, 1500.0);
  // Damped by a quarter to all of what would just keep it from swinging.
  hand.grip_damping = between(0.25, 1.0) * 2.0 * std::sqrt(hand.grip_stiffness * hand.mass);
  hand.inertia = spread(5e-5, 5e-4);
  hand.grip_turn_stiffness = spread(0.05, 1.0);
  hand.grip_turn_damping =
      between(0.25, 1.0) * 2.0 * std::sqrt(hand.grip_turn_stiffness * hand.inertia);
  hand.tremor = between(0.0, 0.2);
  hand.encoder_step = between(0.0, 8e-5);
  hand.encoder_turn_step = between(0.0, 1.5e-3);
  hand.largest_force = spread(3.0, 12.0);
  hand.delay = static_cast<std::uint32_t>(between(0.0, 3.0));
  return hand;
}

DeviceTraits device_of(const HandTraits& hand, double period) {
  DeviceTraits device;
  device.damping = hand.device_damping;
  device.turn_damping = hand.device_turn_damping;
  device.mass = hand.mass;
  device.inertia = hand.inertia;
  device.encoder_step = hand.encoder_step;
  device.encoder_turn_step = hand.encoder_turn_step;
  device.period = period;
  device.delay = (hand.delay + hand.jitter) * period;
  device.largest_force = hand.largest_force;
  device.largest_torque = hand.largest_torque;
  return device;
}

EmulatedHand::EmulatedHand(const HandTraits& traits, const Pose& start, std::uint32_t seed)
    : traits_(traits), state_{start, glm::dvec3(0.0), glm::dvec3(0.0)}, random_(seed) {}

Pose EmulatedHand::measured() const {
  const glm::dvec3 turn = turn_between(glm::dquat(1.0, 0.0, 0.0, 0.0), state_.pose.rotation);
  return {counted(traits_.encoders * state_.pose.position, traits_.encoder_step),
          quaternion(counted(turn, traits_.encoder_turn_step))};
}

void EmulatedHand::move(const Wrench& wrench, const Pose& wanted, double period) {
  late_[at_ % kLongestDelay] = wrench;
  const std::uint32_t later =
      traits_.jitter > 0 ? std::uniform_int_distribution<std::uint32_t>(0, traits_.jitter)(random_)
                         : 0U;
  const Wrench& due = late_[(at_ + kLongestDelay - traits_.delay - later) % kLongestDelay];
  at_ += 1;
  if (std::uniform_real_distribution<double>()(random_) >= traits_.dropped) {
    felt_ = {traits_.motors * at_most(due.force, traits_.largest_force),
             traits_.turn_motor * at_most(due.torque, traits_.largest_torque)};
  }
  std::normal_distribution<double> normal(0.0, 1.0);
  const double x = normal(random_);
  const double y = normal(random_);
  const glm::dvec3 tremor = traits_.tremor * glm::dvec3(x, y, normal(random_));
  constexpr int kParts = 20;  // semi-implicit Euler: the stiffest grip has 80 rad/s
  const double dt = period / kParts;
  for (int part = 0; part < kParts; ++part) {
    const glm::dvec3 force = felt_.force + tremor +
                             traits_.grip_stiffness * (wanted.position - state_.pose.position) -
                             (traits_.grip_damping + traits_.device_damping) * state_.velocity;
    const glm::dvec3 torque =
        felt_.torque +
        traits_.grip_turn_stiffness * turn_between(state_.pose.rotation, wanted.rotation) -
        (traits_.grip_turn_damping + traits_.device_turn_damping) * state_.angular_velocity;
    state_.velocity += force * (dt / traits_.mass);
    state_.angular_velocity += torque * (dt / traits_.inertia);
    const glm::dvec3 shift = state_.velocity * dt;
    const glm::dvec3 turn = state_.angular_velocity * dt;
    motor_work_ += glm::dot(felt_.force, shift) + glm::dot(felt_.torque, turn);
    state_.pose.position += shift;
    state_.pose.rotation = glm::normalize(quaternion(turn) * state_.pose.rotation);
  }
}

}  // namespace torsion::engine::test
