#pragma once

// An emulated device in an emulated hand: its motors push the hand by the device's own geometry,
// and the hand moves its encoders. What a motor or an encoder of it may be wrong in.

#include <array>

#include "tests/device/emulated_devices.hpp"
#include "tests/device/wooden_arm.hpp"
#include "tests/systems/hold/emulated_hand.hpp"

namespace torsion::engine::test {

/// What is not as the driver thinks. A device that only turns has motor 0 and encoder 0.
struct Miswiring {
  std::array<double, 3> motors{1.0, 1.0, 1.0};    // -1: turns the other way
  std::array<double, 3> encoders{1.0, 1.0, 1.0};  // -1: counts the other way; not a Falcon's
  double strength = 1.0;                          // of the motors, over what the driver counts on
  glm::dvec3 home{0.0};  // a Falcon: m, a WoodenHaptics: rad off, when its zero was set
};

class HandledDevice {
 public:
  HandledDevice(const HandTraits& hand, const Miswiring& wrong, std::uint32_t seed);

  /// The hand wants to be at `wanted` [world, from where it begins].
  void move(EmulatedDevice& device, const Pose& wanted, double period);
  [[nodiscard]] const MovingFrame& handle() const { return hand_.state(); }

 private:
  [[nodiscard]] Wrench push_of(const EmulatedDevice& device) const;
  /// @param way  m, world: that the handle went
  void count(EmulatedDevice& device, const glm::dvec3& way);

  Miswiring wrong_;
  EmulatedHand hand_;
  WoodenArm arm_;  // where the device is a WoodenHaptics
};

}  // namespace torsion::engine::test
