#pragma once

// Devices made up of software, as far as their packets go: what they say to what they are told.
// They stand behind a made-up bus and behind an emulated kernel alike.

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "device/drivers/drivers.hpp"

namespace torsion::engine::test {

using Buffer = std::vector<std::uint8_t>;

/// Deflected by what a test says; sends its reports when asked to by the test.
struct EmulatedSpaceMouse {
  bool has_descriptor = true;
  bool light = false;
};

struct EmulatedFalcon {
  bool has_firmware = true;
  bool homed = true;
  std::uint8_t buttons = 0;
  glm::dvec3 place{0.0, 0.0, 0.115};     // m, device axes
  std::array<std::int16_t, 3> motors{};  // as told last
  bool keeps_what_it_heard = false;
  std::vector<std::array<std::int16_t, 3>> heard;  // of motors, where it keeps that
  Buffer firmware;                                 // as it arrived
  std::size_t firmware_size = 0;                   // how long it is to be
  bool echoes_wrongly = false;
  std::uint32_t loses_ready = 0;  // so many echoes of "ready" get lost; a second "ready" is a byte
                                  // of firmware
  bool is_ready = false;
  std::uint32_t baud = 0;     // divisor
  std::uint64_t packets = 0;  // told so far
};

/// Held at home, and its button pressed, when it is plugged in.
struct EmulatedWooden {
  std::array<std::int16_t, 6> encoders{};
  bool button = false;
  bool says_pressed = true;                // its firmware does until command 1 arrives
  std::uint32_t loses = 0;                 // so many commands 1 get lost
  std::array<std::int16_t, 3> currents{};  // mA, as told last
  std::uint32_t calibrations = 0;
};

struct EmulatedOdrive {
  double turns = 0.0;
  double torque = 0.0;  // N m, as told last
  bool closed_loop = false;
  bool calibrated = true;
  std::uint32_t errors = 0;   // of its axis, until they are cleared
  double found_torque = 0.3;  // N m, that another program has left; with `torque` once it obeys
  bool fed = false;           // its watchdog counts since it was
  bool watched = false;       // its watchdog is on
  bool armed_with_torque = false;                     // it obeyed while a torque was left
  std::array<const char*, 3> version{"0", "5", "6"};  // as it answers: major, minor, revision
  Buffer line;
};

/// A moteus behind an fdcanusb: registers, and the lines that carry them.
struct EmulatedMoteus {
  double turns = 0.0;
  double torque = 0.0;  // N m, that its motor has
  std::uint8_t mode = 0;
  std::uint8_t fault = 0;  // its mode is 1 then, until it is stopped
  double watchdog = 0.0;   // s, as told last
  std::uint32_t register_map = 5;
  bool bus_is_on = false;
  bool is_stiff = false;     // it was told to go somewhere, or to damp
  std::uint32_t errors = 0;  // lines and frames that it could not read
  Buffer line;
};

using EmulatedDevice = std::variant<EmulatedSpaceMouse, EmulatedFalcon, EmulatedWooden,
                                    EmulatedOdrive, EmulatedMoteus>;

/// Takes a packet on the OUT endpoint, as below.
Buffer told(EmulatedMoteus& device, Bytes packet);

/// What it does not remember when it was without power.
void switch_on(EmulatedDevice& device);

/// Takes a packet on the OUT endpoint.
/// @return what the device puts on its IN endpoint, one USB packet; empty: nothing
Buffer told(EmulatedDevice& device, Bytes packet);

/// A control transfer. @return the data stage of one that comes in; nothing: the device stalls
std::optional<Buffer> controlled(EmulatedDevice& device, const UsbSetup& setup, Bytes data);

/// What its motors hold, of what they may at most.
double share_pushed(const EmulatedDevice& device);

/// It was without power for a moment: what it forgets, and its motors hold nothing.
void brown_out(EmulatedDevice& device);

/// True where the device's motors hold nothing.
bool without_force(const EmulatedDevice& device);

/// As the device would be found on a bus.
UsbIdentity identity_of(const EmulatedDevice& device);
/// The same as the kernel has it: device and configuration descriptor.
Buffer descriptors_of(const EmulatedDevice& device);

/// A SpaceMouse's report of three axes, raw counts; id 1 translation, 2 rotation.
Buffer space_mouse_report(std::uint8_t id, std::array<std::int16_t, 3> axes);

}  // namespace torsion::engine::test
