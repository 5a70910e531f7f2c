#include "device/protocols/wooden_haptics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace torsion::engine {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

enum class Command : std::int16_t { kCurrents = 0, kSetEncoders = 1 };

}  // namespace

std::optional<WoodenInput> decode_wooden(Bytes packet) {
  if (packet.size() < kWoodenPacket) {
    return std::nullopt;
  }
  WoodenInput input;
  for (std::size_t i = 0; i < input.encoders.size(); ++i) {
    input.encoders[i] = int16_at(packet, 2 * i);
  }
  input.info = int16_at(packet, 12);
  return input;
}

std::array<std::uint8_t, kWoodenPacket> encode_wooden_currents(
    const std::array<std::int16_t, 3>& milliamperes) {
  std::array<std::uint8_t, kWoodenPacket> packet{};
  for (std::size_t motor = 0; motor < milliamperes.size(); ++motor) {
    put_int16(packet, 2 * motor,
              std::clamp<std::int16_t>(milliamperes[motor], -kWoodenLargestCurrent,
                                       kWoodenLargestCurrent));
  }
  put_int16(packet, 6, static_cast<std::int16_t>(Command::kCurrents));
  return packet;
}

std::array<std::uint8_t, kWoodenPacket> encode_wooden_calibration(
    const std::array<std::int16_t, 6>& encoders) {
  std::array<std::uint8_t, kWoodenPacket> packet{};
  put_int16(packet, 6, static_cast<std::int16_t>(Command::kSetEncoders));
  for (std::size_t i = 0; i < 3; ++i) {
    put_int16(packet, 2 * i, encoders[3 + i]);  // the wrist's go where the currents would
    put_int16(packet, 8 + 2 * i, encoders[i]);
  }
  return packet;
}

WoodenGeometry wooden_haptics_2015() {
  return {0.080,
          0.205,
          0.245,
          glm::dvec3(0.010),
          {0.160, 0.120, 0.120},
          glm::dvec3(1.0),
          {0.220, 0.0, 0.080},
          glm::dvec3(0.0259),
          2000.0,
          {0, 0, 6000, 0, 0, 0}};
}

glm::dvec3 wooden_body_angles(const WoodenGeometry& geometry, const WoodenInput& input) {
  const glm::dvec3 counts(input.encoders[0], input.encoders[1], input.encoders[2]);
  const glm::dvec3 motors = counts * (kTurn / geometry.counts_per_turn);
  return geometry.turns_with_motor * motors * geometry.capstan / geometry.body;
}

glm::dvec3 wooden_position(const WoodenGeometry& geometry, const glm::dvec3& body_angles) {
  const double out =
      geometry.length_b * std::sin(body_angles.y) + geometry.length_c * std::sin(body_angles.z);
  return glm::dvec3(std::cos(body_angles.x) * out, std::sin(body_angles.x) * out,
                    geometry.length_a + geometry.length_b * std::cos(body_angles.y) -
                        geometry.length_c * std::cos(body_angles.z)) -
         geometry.origin;
}

glm::dmat3 wooden_jacobian(const WoodenGeometry& geometry, const glm::dvec3& body_angles) {
  const double cos_a = std::cos(body_angles.x);
  const double sin_a = std::sin(body_angles.x);
  const double along_b = geometry.length_b * std::cos(body_angles.y);
  const double along_c = geometry.length_c * std::cos(body_angles.z);
  const double across_b = geometry.length_b * std::sin(body_angles.y);
  const double across_c = geometry.length_c * std::sin(body_angles.z);
  const double out = across_b + across_c;
  return {glm::dvec3(-sin_a * out, cos_a * out, 0.0),
          glm::dvec3(cos_a * along_b, sin_a * along_b, -across_b),
          glm::dvec3(cos_a * along_c, sin_a * along_c, across_c)};
}

std::array<std::int16_t, 3> wooden_currents(const WoodenGeometry& geometry,
                                            const glm::dvec3& body_angles,
                                            const glm::dvec3& force) {
  const glm::dvec3 torque = glm::transpose(wooden_jacobian(geometry, body_angles)) * force;
  const glm::dvec3 motor_torque =
      geometry.turns_with_motor * torque * geometry.capstan / geometry.body;
  glm::dvec3 milliamperes = 1000.0 * motor_torque / geometry.torque_constant;
  const glm::dvec3 sizes = glm::abs(milliamperes);
  const double largest = std::max({sizes.x, sizes.y, sizes.z});
  std::array<std::int16_t, 3> currents{};
  if (!std::isfinite(largest)) {
    return currents;
  }
  if (largest > kWoodenLargestCurrent) {
    milliamperes *= kWoodenLargestCurrent / largest;
  }
  for (glm::length_t motor = 0; motor < 3; ++motor) {
    currents[static_cast<std::size_t>(motor)] =
        static_cast<std::int16_t>(std::lround(milliamperes[motor]));
  }
  return currents;
}

}  // namespace torsion::engine
