#include "device/drivers/wooden_driver.hpp"

#include <algorithm>

namespace torsion {
namespace {

constexpr double kSilence = 5e-3;  // s: live, then it is told to let go and asked again
constexpr double kLost = 0.25;     // s: then it is set up anew
constexpr double kRetry = 0.5;     // s

void let_go(WoodenDriver& driver, DriverCall& call) {
  let_go_through(driver.writes, call, encode_wooden_currents({}));
}

void again_later(WoodenDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go(driver, call);
  driver.phase = WoodenPhase::kClaiming;
  set_state(call, DeviceState::kStarting, trouble);
  call.report.wake_at = call.now + kRetry;
}

const UsbInterface* interface_of(const UsbIdentity& identity) {
  const auto found = std::ranges::find_if(identity.interfaces, [](const UsbInterface& interface) {
    return find_endpoint(interface, UsbEndpointKind::kInterrupt, kUsbIn) != nullptr &&
           find_endpoint(interface, UsbEndpointKind::kInterrupt, 0) != nullptr;
  });
  return found != identity.interfaces.end() ? &*found : nullptr;
}

void take_packet(WoodenDriver& driver, DriverCall& call, const WoodenInput& input) {
  driver.heard_at = call.now;
  call.report.wake_at = call.now + kSilence;
  const bool button = input.info == 1;
  if (button && !driver.calibrating) {
    // It is held where its encoders are to be zero: they count from there, without force.
    driver.calibrating = true;
    set_state(call, DeviceState::kStarting, DeviceTrouble::kNotHomed);
    write_through(driver.writes, call, encode_wooden_calibration({}));
    return;
  }
  driver.calibrating = button;
  if (button) {
    let_go(driver, call);
    return;
  }
  driver.phase = WoodenPhase::kLive;
  set_state(call, DeviceState::kLive);
  const glm::dvec3 angles = wooden_body_angles(driver.geometry, input);
  const Pose pose{wooden_to_world(wooden_position(driver.geometry, angles)),
                  wooden_to_world(wooden_rotation(driver.geometry, input))};
  const Wrench wrench = publish_pose(call, pose, 0);
  write_through(driver.writes, call,
                encode_wooden_currents(
                    wooden_currents(driver.geometry, angles, world_to_wooden(wrench.force))));
}

}  // namespace

glm::dvec3 wooden_to_world(const glm::dvec3& base) {
  return {base.y, base.z, base.x};
}

glm::dvec3 world_to_wooden(const glm::dvec3& world) {
  return {world.z, world.x, world.y};
}

glm::dquat wooden_to_world(const glm::dquat& base) {
  return {base.w, base.y, base.z, base.x};
}

void begin(WoodenDriver& driver, DriverCall& call) {
  const ReadQueue reads = driver.reads;  // those under way stay so
  const WriteGate writes = driver.writes;
  driver = {};
  driver.reads = reads;
  driver.reads.failures = 0;
  driver.writes = writes;
  DeviceSample& sample = call.report.sample;
  sample.sensed = kTranslationAxes | kRotationAxes;
  sample.actuated = kTranslationAxes;
  sample.traits = {};
  sample.traits.encoder_step = 50e-6;      // m: a count of a motor at the end of the arm
  sample.traits.largest_force = 5.0;       // N, as its makers say of the build of 2015
  sample.traits.largest_stiffness = 1e3;   // N/m, likewise
  sample.traits.encoder_turn_step = 6e-3;  // rad: a count of the wrist
  const UsbInterface* interface = interface_of(call.identity);
  if (interface == nullptr) {
    driver.phase = WoodenPhase::kNone;
    set_state(call, DeviceState::kStarting, DeviceTrouble::kNotUnderstood);
    return;
  }
  driver.reads.endpoint = find_endpoint(*interface, UsbEndpointKind::kInterrupt, kUsbIn)->address;
  driver.reads.length = 64;
  driver.writes.endpoint = find_endpoint(*interface, UsbEndpointKind::kInterrupt, 0)->address;
  set_state(call, DeviceState::kStarting, sample.trouble);
  claim_usb(call.requests, interface->number);
}

void take(WoodenDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.job == UsbJob::kWrite) {
    if (take_write(driver.writes, call, event)) {
      let_go(driver, call);
    }
    return;
  }
  if (driver.phase == WoodenPhase::kNone) {
    return;
  }
  if (event.job == UsbJob::kClaim) {
    if (event.status != UsbStatus::kCompleted) {
      set_state(call, DeviceState::kStarting,
                event.status == UsbStatus::kNoAccess ? DeviceTrouble::kNoAccess
                                                     : DeviceTrouble::kHeldElsewhere);
      call.report.wake_at = call.now + kRetry;
      return;
    }
    driver.phase = WoodenPhase::kAsking;
    driver.heard_at = call.now;
    keep_reading(driver.reads, call);
    let_go(driver, call);  // it answers to this
    call.report.wake_at = call.now + kSilence;
    return;
  }
  switch (take_read(driver.reads, call, event)) {
    case ReadOutcome::kData:
      if (const auto input = decode_wooden(event.bytes)) {
        take_packet(driver, call, *input);
      } else {
        call.report.counts.garbage += 1;
        let_go(driver, call);
      }
      keep_reading(driver.reads, call);
      break;
    case ReadOutcome::kBroken:
      again_later(driver, call, DeviceTrouble::kSilent);
      break;
    case ReadOutcome::kNothing:
      if (event.status != UsbStatus::kCompleted) {
        let_go(driver, call);  // nothing is known of where it is
      }
      break;
  }
}

void wake(WoodenDriver& driver, DriverCall& call) {
  if (driver.phase == WoodenPhase::kClaiming) {
    call.report.wake_at = kNever;
    begin(driver, call);
  } else if (driver.phase == WoodenPhase::kNone) {
    call.report.wake_at = kNever;
  } else if (call.now - driver.heard_at > kLost) {
    again_later(driver, call, DeviceTrouble::kSilent);
  } else {
    let_go(driver, call);
    call.report.wake_at = call.now + kSilence;
  }
}

void rest(WoodenDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == WoodenPhase::kAsking || driver.phase == WoodenPhase::kLive) {
    driver.writes.under_way = false;  // whatever is on its way, this one is to be the last
    let_go(driver, call);
  }
  driver.phase = WoodenPhase::kNone;
}

}  // namespace torsion
