#include "device/drivers/wooden_driver.hpp"

#include <algorithm>

#include <glm/gtc/quaternion.hpp>

namespace torsion::engine {
namespace {

constexpr double kLetGoOfButton = 0.1;  // s: then it is pressed no longer

const UsbInterface* interface_of(const UsbIdentity& identity) {
  const auto found = std::ranges::find_if(identity.interfaces, [](const UsbInterface& interface) {
    return find_endpoint(interface, UsbEndpointKind::kInterrupt, kUsbIn) != nullptr &&
           find_endpoint(interface, UsbEndpointKind::kInterrupt, 0) != nullptr;
  });
  return found != identity.interfaces.end() ? &*found : nullptr;
}

/// Its encoders count from where it was switched on, wherever that was: it has no force before
/// somebody has held it at home and pressed its button.
void take_packet(WoodenDriver& driver, DriverCall& call, const WoodenInput& input) {
  heard(driver, call);
  if (input.info == 1) {
    // The firmware says so until it is told to set its encoders; one packet may have been lost.
    driver.calibrated = true;
    driver.pressed_at = call.now;
    driver.phase = WoodenPhase::kAsking;
    set_state(call, DeviceState::kStarting, DeviceTrouble::kNotHomed);
    write_through(driver.writes, call, encode_wooden_calibration(driver.geometry.home));
    return;
  }
  if (!driver.calibrated || call.now - driver.pressed_at < kLetGoOfButton) {
    set_state(call, DeviceState::kStarting, DeviceTrouble::kNotHomed);
    let_go(driver, call);
    return;
  }
  driver.phase = WoodenPhase::kLive;
  set_state(call, DeviceState::kLive);
  const glm::dvec3 angles = wooden_body_angles(driver.geometry, input);
  const Pose pose{wooden_to_world(wooden_position(driver.geometry, angles)),
                  glm::dquat(1.0, 0.0, 0.0, 0.0)};
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

void let_go(WoodenDriver& driver, DriverCall& call) {
  let_go_through(driver.writes, call, encode_wooden_currents({}));
}

void again_later(WoodenDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go(driver, call);
  driver.phase = WoodenPhase::kClaiming;
  retry_later(call, trouble);
}

void begin(WoodenDriver& driver, DriverCall& call) {
  const bool calibrated = driver.calibrated;
  driver = fresh(driver);
  driver.calibrated = calibrated;
  DeviceSample& sample = call.report.sample;
  sample.sensed = kTranslationAxes;
  sample.actuated = kTranslationAxes;
  sample.traits = {};
  sample.traits.encoder_step = 64e-6;     // m: a count of motor c at the end of the arm
  sample.traits.largest_force = 5.0;      // N, as its makers say of the build of 2015
  sample.traits.largest_stiffness = 1e3;  // N/m, likewise
  set_cautious_heat(sample.traits);
  sample.traits.thermal_time = 4.0;  // s: its servo drives' for more (haptikfabrikenapi)
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

}  // namespace torsion::engine
