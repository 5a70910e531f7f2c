#pragma once

// WoodenHaptics by J. Forsslund, the build of 2015: three motors with encoders, packets of 14 bytes
// by HID, 1 kHz. The stage switches itself off when it hears nothing for half a second. Numbers and
// signs as in haptikfabrikenapi b8d6c94, "woodenhaptics_v2015".

#include <array>
#include <cstdint>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "device/protocols/bytes.hpp"

namespace torsion::engine {

inline constexpr std::size_t kWoodenPacket = 14;

struct WoodenInput {
  std::array<std::int16_t, 6> encoders{};  // counts: body a, b, c; three more that this build lacks
  std::int16_t info = 0;  // 1: its calibration button was pressed, until its encoders are set
};

/// @param packet  at least 14 bytes; raw HID pads to 64
std::optional<WoodenInput> decode_wooden(Bytes packet);

/// Motor currents, mA. Clamped to +-kWoodenLargestCurrent: its maker caps them there, for the
/// stages "can't do more than that for 4 s" (haptikfabrikenapi).
inline constexpr std::int16_t kWoodenLargestCurrent = 2000;
std::array<std::uint8_t, kWoodenPacket> encode_wooden_currents(
    const std::array<std::int16_t, 3>& milliamperes);

/// Sets the encoders, which count from where the device was switched on.
std::array<std::uint8_t, kWoodenPacket> encode_wooden_calibration(
    const std::array<std::int16_t, 6>& encoders);

/// What one build of the device measures.
struct WoodenGeometry {
  double length_a, length_b, length_c;  // m
  glm::dvec3 capstan;                   // m: radii on the motors
  glm::dvec3 body;                      // m: radii of the driven bodies
  glm::dvec3 turns_with_motor;          // 1 where body and motor turn alike, -1 where not
  glm::dvec3 origin;                    // m: of the workspace, in the base's axes
  glm::dvec3 torque_constant;           // N m/A
  double counts_per_turn;               // of the motors' encoders
  std::array<std::int16_t, 6> home;     // counts: where it is held when it is calibrated
};

/// The build of 2015.
WoodenGeometry wooden_haptics_2015();

/// Angles of the three bodies from the motors' encoders, rad.
glm::dvec3 wooden_body_angles(const WoodenGeometry& geometry, const WoodenInput& input);

/// Position of the wrist from the workspace's origin, m; base axes, z up.
glm::dvec3 wooden_position(const WoodenGeometry& geometry, const glm::dvec3& body_angles);

/// d(position)/d(body angles), m/rad.
glm::dmat3 wooden_jacobian(const WoodenGeometry& geometry, const glm::dvec3& body_angles);

/// Currents for a force [N, base axes], made smaller all alike where one is too large.
std::array<std::int16_t, 3> wooden_currents(const WoodenGeometry& geometry,
                                            const glm::dvec3& body_angles, const glm::dvec3& force);

}  // namespace torsion::engine
