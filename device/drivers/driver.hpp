#pragma once

// What every driver of a device shares. A driver is a plain struct and four functions:
//   begin  the device is open: ask for what its set-up needs
//   take   a request has ended
//   wake   the time that it asked for has come
//   rest   it will be closed: leave the motors without force
// Each gets a DriverCall, reads the time from it and puts requests into it, and never waits.

#include <limits>
#include <numbers>
#include <span>

#include "device/usb/usb_io.hpp"
#include "ecs/device_sample.hpp"

namespace torsion::engine {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// What a user may say of the devices.
struct DriverOptions {
  std::span<const std::uint8_t> falcon_firmware;  // empty: none is known
  double largest_knob_torque = 0.2;               // N m
  double wheel_torque = 0.0;                      // N m, of a wheel's full scale; 0: not known
  double wheel_range = 5.0 * std::numbers::pi;    // rad, of a wheel from lock to lock
  bool wheel_reversed = false;                    // its torque goes the other way
};

/// What went wrong on the wire so far.
struct DriverCounts {
  std::uint64_t garbage = 0;   // packets that were no packets
  std::uint64_t stalls = 0;    // endpoints that had to be cleared
  std::uint64_t failures = 0;  // transfers that failed otherwise
};

/// What a driver keeps up to date for others to read.
struct DriverReport {
  DeviceSample sample;
  double wake_at = kNever;  // s
  DriverCounts counts;
};

/// Who wants the samples, and says what wrench the device shall display after each.
struct SampleSink {
  void* context = nullptr;
  Wrench (*on_sample)(void* context, const DeviceSample& sample) = nullptr;
};

struct DriverCall {
  double now = 0.0;  // s, steady clock
  const UsbIdentity& identity;
  const DriverOptions& options;
  DriverReport& report;
  UsbRequests& requests;
  SampleSink sink;
};

/// A new pose: counts and dates the sample.
/// @return the wrench to display, world axes; zero while the device is not live
Wrench publish_pose(DriverCall& call, const Pose& pose, std::uint32_t buttons);

/// The sink hears of it where it is new. Going live begins an epoch.
void set_state(DriverCall& call, DeviceState state, DeviceTrouble trouble = DeviceTrouble::kNone);

/// Not live because of `trouble`; wakes in a while to try again.
void retry_later(DriverCall& call, DeviceTrouble trouble);

/// Likewise after a claim that was refused, with the trouble that this says.
void retry_claim(DriverCall& call, const UsbEvent& claim);

/// The first endpoint of this kind and direction (0 or kUsbIn); null where there is none.
const UsbEndpoint* find_endpoint(const UsbInterface& interface, UsbEndpointKind kind,
                                 std::uint8_t direction);

/// One packet at a time on the way out, and whether one that lets go of the motors is to follow it.
struct WriteGate {
  double asked_at = 0.0;  // s: when it was written
  std::uint8_t endpoint = 0;
  bool under_way = false;
  bool let_go_after = false;
};

/// Writes a packet, unless one is on its way: then the next answer will bring a newer one.
/// @param may_take_long  it is no force
void write_through(WriteGate& gate, DriverCall& call, Bytes packet, bool may_take_long = false);

/// Writes a packet that takes the force off the motors, now or as soon as the gate is free.
/// @return false where it has to wait: take_write says when
bool let_go_through(WriteGate& gate, DriverCall& call, Bytes packet);

/// Writes a packet whatever is on its way: it is to be the last.
void write_last(WriteGate& gate, DriverCall& call, Bytes packet);

/// The end of a write; a force's tells how late it is. @return true where a packet that lets go is
/// owed, now
bool take_write(WriteGate& gate, DriverCall& call, const UsbEvent& event);

/// Reads that are always under way on one endpoint.
struct ReadQueue {
  std::uint8_t endpoint = 0;
  std::uint16_t length = 0;
  std::uint32_t under_way = 0;
  std::uint32_t failures = 0;  // since the last that went well
};

enum class ReadOutcome : std::uint8_t {
  kNothing,  // the event was none of this queue's, or is dealt with
  kData,     // event.bytes is what came
  kBroken,   // nothing goes any more: set up anew
};

/// Asks for reads until two are under way, so that the bus always has one.
void keep_reading(ReadQueue& queue, DriverCall& call);

/// Keeps the queue going past stalls and failures. After kData: call keep_reading.
ReadOutcome take_read(ReadQueue& queue, DriverCall& call, const UsbEvent& event);

}  // namespace torsion::engine
