#include "tests/device/wooden_arm.hpp"

#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

namespace torsion::engine::test {
namespace {

/// d(place)/d(angles), m/rad, by differences: not by the driver's own.
glm::dmat3 ways_of(const WoodenArm& arm) {
  constexpr double kDifference = 1e-6;  // rad
  glm::dmat3 ways;
  for (glm::length_t i = 0; i < 3; ++i) {
    glm::dvec3 more = arm.angles;
    more[i] += kDifference;
    ways[i] = (wooden_position(arm.geometry, more) - place_of(arm)) / kDifference;
  }
  return ways;
}

}  // namespace

WoodenArm::WoodenArm(const glm::dvec3& off) {
  WoodenInput home;
  home.encoders = geometry.home;
  start = wooden_body_angles(geometry, home) + off;
  angles = start;
}

glm::dvec3 place_of(const WoodenArm& arm) {
  return wooden_position(arm.geometry, arm.angles);
}

glm::dvec3 push_of(const WoodenArm& arm, const EmulatedWooden& device) {
  const WoodenGeometry& geometry = arm.geometry;
  glm::dvec3 torque;
  for (glm::length_t i = 0; i < 3; ++i) {
    const auto motor = static_cast<std::size_t>(i);
    torque[i] = arm.motors[motor] * 1e-3 * device.currents[motor] * geometry.torque_constant[i] *
                geometry.body[i] / geometry.capstan[i] * geometry.turns_with_motor[i];
  }
  return glm::inverse(glm::transpose(ways_of(arm))) * torque;
}

void move_by(WoodenArm& arm, EmulatedWooden& device, const glm::dvec3& way) {
  const WoodenGeometry& geometry = arm.geometry;
  arm.angles += glm::inverse(ways_of(arm)) * way;
  const glm::dvec3 turned = arm.angles - arm.start;
  for (glm::length_t i = 0; i < 3; ++i) {
    const auto encoder = static_cast<std::size_t>(i);
    const double motor =
        geometry.turns_with_motor[i] * turned[i] * geometry.body[i] / geometry.capstan[i];  // rad
    const double counts = motor * geometry.counts_per_turn / (2.0 * std::numbers::pi);
    device.encoders[encoder] = static_cast<std::int16_t>(
        geometry.home[encoder] + std::lround(arm.encoders[encoder] * counts));
  }
}

}  // namespace torsion::engine::test
