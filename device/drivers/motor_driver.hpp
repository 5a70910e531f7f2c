#pragma once

// What drivers of devices with motors share, which say where they are when they are spoken to. Such
// a driver D has phases from kClaiming to kLive and kNone, `reads`, `writes` and `heard_at`, and
// besides the four functions of every driver
//   let_go       takes the force off the motors, which the device answers
//   again_later  does that and sets the device up anew in a while

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/drivers/driver.hpp"

namespace torsion::engine {

inline constexpr double kSilence = 4e-3;  // s: then it is told to let go and asked again
inline constexpr double kLost = 0.25;     // s: then it is set up anew
inline constexpr double kArms = 0.25;     // s: until a motor obeys, after it was told to

/// What motors bear for ever where no data sheet says it: half of their largest, warm after ten
/// seconds.
inline void set_cautious_heat(DeviceTraits& traits) {
  traits.continuous_force = 0.5 * traits.largest_force;
  traits.continuous_torque = 0.5 * traits.largest_torque;
  traits.thermal_time = 10.0;
}

/// A driver as it is at first, but for what is under way.
template <class D>
D fresh(const D& driver) {
  D made;
  made.reads = driver.reads;
  made.reads.failures = 0;
  made.writes = driver.writes;
  return made;
}

/// Nothing more is tried until it is plugged in again.
template <class D>
void give_up(D& driver, DriverCall& call, DeviceTrouble trouble) {
  driver.phase = decltype(D::phase)::kNone;
  set_state(call, DeviceState::kStarting, trouble);
  call.report.wake_at = kNever;
}

/// How often a motor is told to let go before nothing more is tried: one packet may get lost.
inline constexpr std::uint32_t kLastWords = 3;

/// Begins to claim; all its talk will be through these endpoints. Null ones: gives up.
template <class D>
void claim_for(D& driver, DriverCall& call, const UsbEndpoint* in, const UsbEndpoint* out,
               std::uint8_t interface) {
  if (in == nullptr || out == nullptr) {
    give_up(driver, call, DeviceTrouble::kNotUnderstood);
    return;
  }
  driver.reads.endpoint = in->address;
  driver.reads.length = 64;  // one packet
  driver.writes.endpoint = out->address;
  set_state(call, DeviceState::kStarting, call.report.sample.trouble);
  claim_usb(call.requests, interface);
}

inline const UsbInterface* find_interface(const UsbIdentity& identity, std::uint8_t device_class) {
  const auto found =
      std::ranges::find(identity.interfaces, device_class, &UsbInterface::device_class);
  return found != identity.interfaces.end() ? &*found : nullptr;
}

/// Begins to claim a serial port (CDC ACM): the kernel's driver holds both of its interfaces. Such
/// a driver has a phase kClaimingData, too, and the number of its interface `data`.
template <class D>
void claim_serial(D& driver, DriverCall& call) {
  constexpr std::uint8_t kCdcControl = 2;
  constexpr std::uint8_t kCdcData = 10;
  const UsbInterface* control = find_interface(call.identity, kCdcControl);
  const UsbInterface* data = find_interface(call.identity, kCdcData);
  if (control == nullptr || data == nullptr) {
    give_up(driver, call, DeviceTrouble::kNotUnderstood);
    return;
  }
  driver.data = data->number;
  claim_for(driver, call, find_endpoint(*data, UsbEndpointKind::kBulk, kUsbIn),
            find_endpoint(*data, UsbEndpointKind::kBulk, 0), control->number);
}

/// The end of a claim. @return true once both interfaces are there; its reads are under way
template <class D>
bool take_serial_claim(D& driver, DriverCall& call, const UsbEvent& event) {
  using Phase = decltype(D::phase);
  if (event.status != UsbStatus::kCompleted) {
    driver.phase = Phase::kClaiming;
    retry_claim(call, event);
    return false;
  }
  if (driver.phase == Phase::kClaiming) {
    driver.phase = Phase::kClaimingData;
    claim_usb(call.requests, driver.data);
    return false;
  }
  driver.heard_at = call.now;
  call.report.wake_at = call.now + kLost;
  keep_reading(driver.reads, call);
  return true;
}

/// A knob's handle, turned by so many turns about its axis.
inline Pose knob_pose(double turns) {
  const double angle = 2.0 * std::numbers::pi * std::remainder(turns, 1.0);
  return {glm::dvec3(0.0), glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0))};
}

/// What every knob says of itself.
/// @param counts  of its encoder, a turn
inline void describe_knob(DriverCall& call, double counts) {
  DeviceSample& sample = call.report.sample;
  sample.sensed = kTurnAxis;
  sample.actuated = kTurnAxis;
  sample.traits = {};
  sample.traits.largest_torque = call.options.largest_knob_torque;
  sample.traits.encoder_turn_step = 2.0 * std::numbers::pi / counts;
  set_cautious_heat(sample.traits);
}

/// It was heard of, and is to be again before long.
template <class D>
void heard(D& driver, DriverCall& call) {
  driver.heard_at = call.now;
  call.report.wake_at = call.now + kSilence;
}

/// Keeps its reads going.
/// @param take_bytes  called with what has come
template <class D, class F>
void take_read_of(D& driver, DriverCall& call, const UsbEvent& event, F&& take_bytes) {
  using Phase = decltype(D::phase);
  switch (take_read(driver.reads, call, event)) {
    case ReadOutcome::kData:
      take_bytes(event.bytes);
      if (driver.phase != Phase::kNone) {
        keep_reading(driver.reads, call);
      }
      break;
    case ReadOutcome::kBroken:
      again_later(driver, call, DeviceTrouble::kSilent);
      break;
    case ReadOutcome::kNothing:
      if (event.status != UsbStatus::kCompleted && driver.phase == Phase::kLive) {
        let_go(driver, call);  // nothing is known of where it is
      }
      break;
  }
}

/// The time has come to claim it again, or it is silent.
template <class D>
void wake_motors(D& driver, DriverCall& call) {
  using Phase = decltype(D::phase);
  call.report.wake_at = kNever;
  if (driver.phase == Phase::kClaiming) {
    begin(driver, call);
  } else if (driver.phase != Phase::kNone && call.now - driver.heard_at > kLost) {
    again_later(driver, call, DeviceTrouble::kSilent);
  } else if (driver.phase != Phase::kNone) {
    let_go(driver, call);
    call.report.wake_at = call.now + kSilence;
  }
}

}  // namespace torsion::engine
