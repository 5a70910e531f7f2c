#include "device/drivers/space_mouse_driver.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "device/drivers/hid_requests.hpp"

namespace torsion::engine {
namespace {

constexpr double kTick = 1e-3;             // s: the pose goes on at the rate of the physics
constexpr double kLongestReport = 0.25;    // s: a deflection that nobody repeats is forgotten
constexpr double kLargestSpeed = 0.1;      // m/s
constexpr double kLargestTurnSpeed = 2.0;  // rad/s
constexpr std::uint8_t kLightReport = 4;

bool is_candidate(const UsbInterface& interface) {
  return interface.device_class == kHidClass && interface.protocol == 0 &&
         find_endpoint(interface, UsbEndpointKind::kInterrupt, kUsbIn) != nullptr;
}

const UsbInterface& interface_of(const SpaceMouseDriver& driver, const DriverCall& call) {
  return call.identity.interfaces[driver.candidate];
}

/// Claims the next interface from driver.candidate on that may be it.
void claim_next(SpaceMouseDriver& driver, DriverCall& call) {
  const auto& interfaces = call.identity.interfaces;
  while (driver.candidate < interfaces.size() && !is_candidate(interfaces[driver.candidate])) {
    driver.candidate += 1;
  }
  if (driver.candidate == interfaces.size() && driver.without_descriptor &&
      is_space_mouse(call.identity.vendor, call.identity.product)) {
    driver.candidate = *driver.without_descriptor;
    driver.last_resort = true;
  }
  if (driver.candidate == interfaces.size()) {
    driver.phase = SpaceMousePhase::kNone;
    set_state(call, DeviceState::kStarting, DeviceTrouble::kNotUnderstood);
    return;
  }
  driver.phase = SpaceMousePhase::kClaiming;
  claim_usb(call.requests, interfaces[driver.candidate].number);
}

void set_light(SpaceMouseDriver& driver, DriverCall& call, bool on) {
  const std::array<std::uint8_t, 2> report = {kLightReport, on ? std::uint8_t{1} : std::uint8_t{0}};
  set_hid_report(call.requests, interface_of(driver, call).number, HidReportKind::kOutput,
                 kLightReport, report);
}

void start_reading(SpaceMouseDriver& driver, DriverCall& call, const SpaceMouseLayout& layout) {
  const UsbEndpoint* endpoint =
      find_endpoint(interface_of(driver, call), UsbEndpointKind::kInterrupt, kUsbIn);
  driver.layout = layout;
  driver.layout.oldest_axes = has_oldest_axes(call.identity.vendor, call.identity.product);
  driver.state = {};
  driver.phase = SpaceMousePhase::kReading;
  driver.reads.endpoint = endpoint->address;
  driver.reads.length = 64;
  driver.reads.failures = 0;
  driver.steered_at = call.now;
  DeviceSample& sample = call.report.sample;
  sample.sensed = kTranslationAxes | kRotationAxes;
  sample.steers_rate = true;
  set_state(call, DeviceState::kLive);
  set_light(driver, call, true);
  keep_reading(driver.reads, call);
  call.report.wake_at = call.now + kTick;
}

void take_descriptor(SpaceMouseDriver& driver, DriverCall& call, const UsbEvent& event) {
  const auto reports = event.status == UsbStatus::kCompleted && !event.bytes.empty()
                           ? parse_hid_descriptor(event.bytes)
                           : std::nullopt;
  if (const auto layout = reports ? space_mouse_layout(*reports) : std::nullopt) {
    start_reading(driver, call, *layout);
    return;
  }
  if (!reports && !driver.without_descriptor) {
    driver.without_descriptor = driver.candidate;
  }
  release_usb(call.requests, interface_of(driver, call).number);
  driver.candidate += 1;
  claim_next(driver, call);
}

void take_claim(SpaceMouseDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.status != UsbStatus::kCompleted) {
    retry_claim(call, event);
  } else if (driver.last_resort) {
    start_reading(driver, call, usual_space_mouse_layout());
  } else {
    driver.phase = SpaceMousePhase::kAsking;
    ask_report_descriptor(call.requests, interface_of(driver, call).number);
  }
}

/// The pose goes on with the deflection until now.
void steer(SpaceMouseDriver& driver, DriverCall& call) {
  if (call.now - driver.reported_at > kLongestReport) {
    driver.state.translation = glm::dvec3(0.0);
    driver.state.rotation = glm::dvec3(0.0);
  }
  const double dt = call.now - driver.steered_at;
  driver.steered_at = call.now;
  Pose pose = call.report.sample.pose;
  glm::dvec3 turn(0.0);
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    pose.position[axis] += kLargestSpeed * dt * steering_response(driver.state.translation[axis]);
    turn[axis] = kLargestTurnSpeed * dt * steering_response(driver.state.rotation[axis]);
  }
  const double angle = glm::length(turn);
  if (angle > 0.0) {
    pose.rotation = glm::normalize(glm::angleAxis(angle, turn / angle) * pose.rotation);
  }
  publish_pose(call, pose, driver.state.buttons);
}

}  // namespace

double steering_response(double deflection) {
  constexpr double kDeadBand = 5.0 / 350.0;
  const double beyond = (std::abs(deflection) - kDeadBand) / (1.0 - kDeadBand);
  return beyond > 0.0 ? std::copysign(beyond * beyond * beyond, deflection) : 0.0;
}

void begin(SpaceMouseDriver& driver, DriverCall& call) {
  const ReadQueue reads = driver.reads;  // those under way stay so
  driver = {};
  driver.reads = reads;
  call.report.sample.pose = {};
  set_state(call, DeviceState::kStarting);
  claim_next(driver, call);
}

void take(SpaceMouseDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.job == UsbJob::kClaim && driver.phase == SpaceMousePhase::kClaiming) {
    take_claim(driver, call, event);
    return;
  }
  if (event.job == UsbJob::kControl && driver.phase == SpaceMousePhase::kAsking) {
    take_descriptor(driver, call, event);
    return;
  }
  if (driver.phase != SpaceMousePhase::kReading) {
    return;
  }
  switch (take_read(driver.reads, call, event)) {
    case ReadOutcome::kData:
      if (take_space_mouse_report(driver.layout, event.bytes, driver.state)) {
        driver.reported_at = call.now;
      } else if (!driver.layout.numbered || !is_other_report(event.bytes)) {
        call.report.counts.garbage += 1;
      }
      keep_reading(driver.reads, call);
      break;
    case ReadOutcome::kBroken:
      driver.phase = SpaceMousePhase::kClaiming;
      retry_later(call, DeviceTrouble::kSilent);
      break;
    case ReadOutcome::kNothing:
      break;
  }
}

void wake(SpaceMouseDriver& driver, DriverCall& call) {
  if (driver.phase == SpaceMousePhase::kReading) {
    steer(driver, call);
    call.report.wake_at = call.now + kTick;
  } else if (driver.phase != SpaceMousePhase::kNone) {
    call.report.wake_at = kNever;
    begin(driver, call);
  }
}

void rest(SpaceMouseDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == SpaceMousePhase::kReading) {
    driver.phase = SpaceMousePhase::kNone;
    set_light(driver, call, false);
  }
}

}  // namespace torsion::engine
