#pragma once

// The devices that are open and what they are together: one sample, one wrench. Runs in the
// device thread, over any bus: events in, requests out.

#include <array>

#include "device/button_turn.hpp"
#include "device/composite.hpp"
#include "device/drivers/drivers.hpp"

namespace torsion::engine {

inline constexpr std::size_t kMostDevices = 6;

/// What a device does for the tool.
enum class DeviceRole : std::uint8_t {
  kNone,
  kTranslation,
  kRotation,
  kTranslationAndRotation,
  kKnob,   // on top of the rotation, if there is another
  kPoint,  // one of two or three that carry the tool
};

/// What was measured of a kind of device; zero where it was not.
struct MeasuredTraits {
  double mass = 0.0;          // kg
  double damping = 0.0;       // N s/m
  double inertia = 0.0;       // kg m^2
  double turn_damping = 0.0;  // N m s/rad
  double delay = 0.0;         // s: from a force asked for to what it does
  double weight = 0.0;        // N: of handle and mechanism, as the motors have to carry it
};

struct LoopOptions {
  DriverOptions drivers;
  TurnButtons turn_buttons;
  std::uint32_t kinds = kUsualDevices;  // bits 1 << DeviceKind: which may be used
  glm::dvec3 turn_axis{0.0, 1.0, 0.0};  // world, at rest: what a knob turns about
  double spacing = 0.2;                 // m: between devices that carry a tool together
  std::array<MeasuredTraits, kDeviceKinds> measured;
};

struct DeviceRow {
  bool used = false;
  DeviceKind kind = DeviceKind::kSpaceMouse;
  UsbIdentity identity;
  Driver driver;
  DriverReport report;
  DeviceRole role = DeviceRole::kNone;
  std::size_t point = 0;  // of kPoint
};

struct DeviceLoop {
  LoopOptions options;
  SampleSink sink;  // gets the samples of all devices as one
  std::array<DeviceRow, kMostDevices> rows;
  CarriedTool carried;
  DeviceSample whole;
  ButtonTurn button_turn;
  Wrench wrench;       // that the sink asked for last
  double asked = 0.0;  // s: when
};

/// A free row, or kMostDevices.
std::size_t free_row(const DeviceLoop& loop);

/// A device of this kind is open at `row`. @pre the row is free
void attach(DeviceLoop& loop, std::size_t row, const UsbIdentity& identity, DeviceKind kind,
            double now, UsbRequests& requests);

/// A device of this kind is there, at `row`, and cannot be opened. @pre the row is free
void refuse(DeviceLoop& loop, std::size_t row, const UsbIdentity& identity, DeviceKind kind,
            DeviceTrouble trouble);

/// A request of the device has ended.
void take(DeviceLoop& loop, std::size_t row, const UsbEvent& event, double now,
          UsbRequests& requests);

/// The time that the device asked for has come.
void wake(DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests);

/// The device will be closed: what leaves its motors without force.
void rest(DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests);

/// What rest() would ask for now, without asking.
void plan_rest(const DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests);

/// The device is gone. From here on no other displays a force that counted on it.
void detach(DeviceLoop& loop, std::size_t row, double now);

/// s: when the first device wants to be woken; kNever where none does.
double next_wake(const DeviceLoop& loop);

/// The time between two forces, s, that the coupling and the passivity controller are to reckon
/// with: as measured, where a device is slower than its driver says.
/// @param said  s: by the driver
/// @param rate  Hz: as measured; 0: not yet
double period_of(double said, double rate);

}  // namespace torsion::engine
