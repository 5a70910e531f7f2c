#include "device/drivers/wooden_driver.hpp"

#include <algorithm>

namespace torsion {
namespace {

const UsbInterface* interface_of(const UsbIdentity& identity) {
  const auto found = std::ranges::find_if(identity.interfaces, [](const UsbInterface& interface) {
    return find_endpoint(interface, UsbEndpointKind::kInterrupt, kUsbIn) != nullptr &&
           find_endpoint(interface, UsbEndpointKind::kInterrupt, 0) != nullptr;
  });
  return found != identity.interfaces.end() ? &*found : nullptr;
}

void take_packet(WoodenDriver& driver, DriverCall& call, const WoodenInput& input) {
  heard(driver, call);
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

void let_go(WoodenDriver& driver, DriverCall& call) {
  let_go_through(driver.writes, call, encode_wooden_currents({}));
}

void again_later(WoodenDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go(driver, call);
  driver.phase = WoodenPhase::kClaiming;
  retry_later(call, trouble);
}

void begin(WoodenDriver& driver, DriverCall& call) {
  driver = fresh(driver);
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
    give_up(driver, call, DeviceTrouble::kNotUnderstood);
    return;
  }
  claim_for(driver, call, find_endpoint(*interface, UsbEndpointKind::kInterrupt, kUsbIn),
            find_endpoint(*interface, UsbEndpointKind::kInterrupt, 0), interface->number);
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
      retry_claim(call, event);
      return;
    }
    driver.phase = WoodenPhase::kAsking;
    heard(driver, call);
    keep_reading(driver.reads, call);
    let_go(driver, call);  // it answers to this
    return;
  }
  take_read_of(driver, call, event, [&](Bytes bytes) {
    if (const auto input = decode_wooden(bytes)) {
      take_packet(driver, call, *input);
    } else {
      call.report.counts.garbage += 1;
      let_go(driver, call);
    }
  });
}

void wake(WoodenDriver& driver, DriverCall& call) {
  wake_motors(driver, call);
}

void rest(WoodenDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == WoodenPhase::kAsking || driver.phase == WoodenPhase::kLive) {
    write_last(driver.writes, call, encode_wooden_currents({}));
  }
  driver.phase = WoodenPhase::kNone;
}

}  // namespace torsion
