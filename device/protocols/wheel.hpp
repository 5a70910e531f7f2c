#pragma once

// Force-feedback wheels of USB's class for physical interface devices (PID): where in its reports a
// wheel's turn is, and how it is told a torque. Source: Device Class Definition for Physical
// Interface Devices 1.0; what the fields are called there stands in wheel.cpp.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "device/protocols/hid_descriptor.hpp"

namespace torsion::engine {

/// A report without its contents.
struct WheelReport {
  std::uint8_t id = 0;
  std::size_t size = 0;  // bytes, with its id
};

/// Where in the reports of one wheel is what Torsion uses of them. Fields of no bits are not there.
struct WheelLayout {
  bool numbered = false;
  WheelReport place;  // that has its turn
  HidField turn;
  std::array<HidField, 32> buttons;
  std::uint32_t button_count = 0;
  HidField enabled;  // its motor obeys
  HidField powered;

  WheelReport effect;  // what an effect is
  HidField effect_block;
  HidField effect_constant;  // that it is a constant torque
  HidField duration;
  HidField effect_gain;
  HidField axis;  // that it acts on X
  HidField has_direction;
  HidField direction;

  WheelReport constant;  // how large its torque is
  HidField constant_block;
  HidField magnitude;

  WheelReport operation;  // that it begins or ends
  HidField operation_block;
  HidField start;
  HidField stop;
  HidField loops;

  WheelReport control;  // of the whole device
  HidField enable;
  HidField reset;

  WheelReport gain;
  HidField device_gain;

  WheelReport create;  // a feature: asks for an effect
  HidField create_constant;

  WheelReport load;  // a feature: the effect that was made
  HidField load_block;
  HidField load_success;
};

/// What the device's own report descriptor says.
/// @return nothing where it has no turn, or no constant torque of both signs
std::optional<WheelLayout> wheel_layout(const HidReports& reports);

/// True for a report descriptor of a device that displays effects, of whatever kind.
bool has_effects(const HidReports& reports);

inline constexpr std::size_t kLargestWheelReport = 64;

struct WheelPacket {
  std::array<std::uint8_t, kLargestWheelReport> bytes{};
  std::size_t size = 0;  // 0: the wheel has no such report

  [[nodiscard]] Bytes data() const { return Bytes(bytes).first(size); }
};

/// A constant torque that ends by itself after `duration` [s], or as near as the wheel counts time.
WheelPacket encode_wheel_effect(const WheelLayout& layout, std::int32_t block, double duration);
/// @param share  -1 to 1 of the wheel's full scale, against X: pushes to the left where it is
///               positive
WheelPacket encode_wheel_torque(const WheelLayout& layout, std::int32_t block, double share);
WheelPacket encode_wheel_start(const WheelLayout& layout, std::int32_t block);
WheelPacket encode_wheel_stop(const WheelLayout& layout, std::int32_t block);
WheelPacket encode_wheel_reset(const WheelLayout& layout);
WheelPacket encode_wheel_enable(const WheelLayout& layout);
/// All that the wheel's owner has allowed it in its own settings.
WheelPacket encode_wheel_gain(const WheelLayout& layout);
/// A feature report.
WheelPacket encode_wheel_create(const WheelLayout& layout);

/// The effect that was made, as the feature report says it.
/// @return nothing where none was
std::optional<std::int32_t> decode_wheel_load(const WheelLayout& layout, Bytes report);

/// What is known of the wheel; a report changes a part of it.
struct WheelState {
  std::int32_t count = 0;
  double turn = 0.0;  // -1 to 1 of half its range, positive to the right
  std::uint32_t buttons = 0;
  bool enabled = false;
  bool powered = false;
};

/// Takes one report into the state.
/// @return false, and the state as it was, where the report says nothing of these or is cut off
bool take_wheel_report(const WheelLayout& layout, Bytes report, WheelState& state);

/// True for a report of the kind that has the wheel's turn.
bool is_of_place(const WheelLayout& layout, Bytes report);

/// Why its motor has no torque, in place of an error's number.
inline constexpr std::uint32_t kWheelSwitchedOff = 1;
inline constexpr std::uint32_t kWheelWithoutPower = 2;

/// What that means and what to do about it.
std::string_view wheel_error_text(std::uint32_t error);

}  // namespace torsion::engine
