#pragma once

// 3Dconnexion's SpaceMouse family: six axes of deflection, read only. They return to zero when let
// go, so they steer a rate.

#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "device/protocols/hid_descriptor.hpp"

namespace torsion::engine {

inline constexpr std::uint16_t k3Dconnexion = 0x256F;  // vendor id

/// Where the six axes and the buttons are in the reports of one device.
struct SpaceMouseLayout {
  std::array<HidField, 6> axes;  // X, Y, Z, Rx, Ry, Rz
  std::array<HidField, 32> buttons;
  std::uint32_t button_count = 0;
  bool numbered = true;
  bool oldest_axes = false;  // x right, y up, z away from the user; else y to the user and z down
};

/// What the device's own report descriptor says.
/// @return nothing where it is no multi-axis controller with all six axes: the mouse or keyboard
///         interface of a receiver, for example
std::optional<SpaceMouseLayout> space_mouse_layout(const HidReports& reports);

/// Where the descriptor cannot be had: translation in report 1, rotation in report 2 or after the
/// translation when report 1 is long enough; buttons in report 3; full deflection 350.
SpaceMouseLayout usual_space_mouse_layout();

/// What is known of the device; a report changes a part of it.
struct SpaceMouseState {
  glm::dvec3 translation{
      0.0};                   // share of full deflection, -1 to 1; +X right, +Y up, +Z to the user
  glm::dvec3 rotation{0.0};   // likewise, about these axes
  std::uint32_t buttons = 0;  // one bit each
};

/// Takes one report into the state.
/// @return false, and the state as it was, where the report says nothing of axes and buttons
bool take_space_mouse_report(const SpaceMouseLayout& layout, Bytes report, SpaceMouseState& state);

/// True for vendor and product ids that 3Dconnexion gives to what has no six axes.
bool is_not_a_space_mouse(std::uint16_t vendor, std::uint16_t product);

/// True for a report that such devices send of something else than axes and buttons: of their
/// battery (0x17) or of their receiver (0x1C).
bool is_other_report(Bytes report);

/// True for those whose raw axes are x right, y up and z away from the user (spacenavd bac572a: no
/// flags).
bool has_oldest_axes(std::uint16_t vendor, std::uint16_t product);

/// True for known ids of the family.
bool is_space_mouse(std::uint16_t vendor, std::uint16_t product);

}  // namespace torsion::engine
