#pragma once

#include <array>
#include <cstdint>
#include <random>

#include <glm/mat3x3.hpp>

#include "ecs/device_sample.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion::engine::test {

/// A hand that holds a haptic device, with no hardware: the arm is a spring and a damper to where
/// the person wants to be, the device a mass with its own damping, its motors saturate, its
/// encoders count, and what goes in and out is late.
struct HandTraits {
  double mass = 0.15;                 // kg: handle and fingers
  double inertia = 2e-4;              // kg m^2
  double device_damping = 1.0;        // N s/m: b
  double device_turn_damping = 1e-3;  // N m s/rad
  double grip_stiffness = 200.0;      // N/m: loose 50, firm 1000
  double grip_damping = 5.0;          // N s/m
  double grip_turn_stiffness = 0.5;   // N m/rad
  double grip_turn_damping = 5e-3;    // N m s/rad
  double tremor = 0.0;                // N, standard deviation of a force held for a millisecond
  double encoder_step = 0.0;          // m; 0: exact
  double encoder_turn_step = 0.0;     // rad
  double largest_force = 10.0;        // N
  double largest_torque = 0.3;        // N m
  std::uint32_t delay = 0;            // samples between a force computed and sent
  std::uint32_t jitter = 0;           // samples: up to this many later, at random
  double dropped = 0.0;               // share of samples that arrive too late to be sent
  glm::dmat3 motors{1.0};             // what they make of a force: the identity where all are right
  double turn_motor = 1.0;            // likewise of a torque
  glm::dvec3 encoders{1.0};           // signs of what they say
};

/// Hands that differ in all that they may, from loose to firm, none of which swings by itself.
HandTraits random_hand(std::mt19937& random);

/// What stability may know of it.
/// @param period  s
DeviceTraits device_of(const HandTraits& hand, double period);

class EmulatedHand {
 public:
  EmulatedHand(const HandTraits& traits, const Pose& start, std::uint32_t seed = 1);

  /// What the device's encoders say, world axes.
  [[nodiscard]] Pose measured() const;
  [[nodiscard]] const MovingFrame& state() const { return state_; }

  /// One period of the device with this wrench, held; the person wants to be at `wanted`.
  void move(const Wrench& wrench, const Pose& wanted, double period);

  /// Work that the motors have done on the handle, J.
  [[nodiscard]] double motor_work() const { return motor_work_; }
  /// The wrench that the motors held last.
  [[nodiscard]] const Wrench& felt() const { return felt_; }

 private:
  static constexpr std::size_t kLongestDelay = 16;

  HandTraits traits_;
  MovingFrame state_;
  Wrench felt_;
  std::array<Wrench, kLongestDelay> late_{};
  std::size_t at_ = 0;
  double motor_work_ = 0.0;
  std::mt19937 random_;
};

}  // namespace torsion::engine::test
