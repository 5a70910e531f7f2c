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

/// A force-feedback wheel that plays effects: an OpenFFBoard, or one that differs from it wherever
/// the class allows. It reports when it has turned, and ten times a second.
struct EmulatedWheel {
  bool is_other = false;
  bool plays_for_ever = false;  // its effects do not end by themselves, as they should
  double turn = 0.0;            // rad, to the right
  double range = 15.7079;       // rad, from lock to lock
  double full_scale = 2.5;      // N m
  std::uint8_t buttons = 0;
  double now = 0.0;  // s
  bool powered = true;
  bool enabled = false;
  bool created = false;  // its effect
  bool plays = false;
  double gain = 0.5;         // of all effects: another program's
  double duration = 0.0;     // s, of its effect
  double direction = 0.0;    // share of the torque that acts, to the left
  double share = 0.0;        // of the full scale
  double started_at = 0.0;   // s
  std::uint32_t errors = 0;  // packets that it could not read, or in a wrong order
  std::uint32_t pings = 0;
  bool said_enabled = false;  // as it reported last
  bool said_powered = false;
  std::int32_t said_count = 0;
  double said_at = 0.0;
};

using EmulatedDevice = std::variant<EmulatedSpaceMouse, EmulatedFalcon, EmulatedWooden,
                                    EmulatedOdrive, EmulatedMoteus, EmulatedWheel>;

/// Takes a packet on the OUT endpoint, as below.
Buffer told(EmulatedMoteus& device, Bytes packet);
Buffer told(EmulatedWheel& device, Bytes packet);

/// A control transfer, as below.
std::optional<Buffer> controlled(EmulatedWheel& device, const UsbSetup& setup, Bytes data);

/// It says where it is, though it has not turned.
Buffer place_of(EmulatedWheel& device);

/// Torque that its motor has, N m, to the left: counter-clockwise for who sits before it.
double torque_of(const EmulatedWheel& device);

/// What a reset, or a moment without power, does.
void forget_effects(EmulatedWheel& device);

/// It is so late: s, of any clock. Devices that do something by themselves have to know.
void set_time(EmulatedDevice& device, double now);

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
