#pragma once

// The bodies of a WoodenHaptics and how they turn: between its motors' currents, its encoders'
// counts and its handle. Axes of its base, z up.

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "device/protocols/wooden_haptics.hpp"
#include "tests/device/emulated_devices.hpp"

namespace torsion::engine::test {

struct WoodenArm {
  WoodenGeometry geometry = wooden_haptics_2015();
  std::array<double, 3> motors{1.0, 1.0, 1.0};    // -1: turns the other way
  std::array<double, 3> encoders{1.0, 1.0, 1.0};  // -1: counts the other way
  glm::dvec3 start{0.0};                          // rad: of its bodies, where it was calibrated
  glm::dvec3 angles{0.0};                         // rad

  /// @param off  rad: from its home, where it is calibrated
  explicit WoodenArm(const glm::dvec3& off = glm::dvec3(0.0));
};

/// m
glm::dvec3 place_of(const WoodenArm& arm);

/// N: with which the motors of the device push its handle.
glm::dvec3 push_of(const WoodenArm& arm, const EmulatedWooden& device);

/// The handle goes on by `way` [m]; the device's encoders count it.
void move_by(WoodenArm& arm, EmulatedWooden& device, const glm::dvec3& way);

}  // namespace torsion::engine::test
