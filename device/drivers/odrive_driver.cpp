#include "device/drivers/odrive_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace torsion::engine {
namespace {

constexpr std::uint32_t kAskEvery = 20;   // steps: asked how it is
constexpr std::uint32_t kAskEvery6 = 50;  // likewise: that step brings no place
constexpr int kAxis = 0;

// Torque control with the axis's own watchdog, so that it lets go when it hears nothing. "u 0"
// feeds that: enabled before it was fed, it is an error one control cycle later, which "sc" clears
// and does not keep from coming back (ODrive firmware 0.5, MotorControl/axis.cpp). No torque of
// another program is left when it obeys, and a quick turn by hand is no overspeed.
constexpr std::array<std::string_view, 7> kSetUp = {
    "w axis0.config.watchdog_timeout 0.05\nu 0\n",
    "w axis0.config.enable_watchdog 1\nu 0\n",
    "sc\nc 0 0\n",
    "w axis0.controller.config.control_mode 1\nu 0\n",
    "w axis0.controller.config.input_mode 1\nu 0\n",
    "w axis0.controller.config.enable_overspeed_error 0\nu 0\n",
    "c 0 0\nw axis0.requested_state 8\n"};
constexpr std::string_view kIdle = "c 0 0\nw axis0.requested_state 1\n";

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write(OdriveDriver& driver, DriverCall& call, std::string_view text) {
  write_through(driver.writes, call, bytes_of(text));
}

void step(OdriveDriver& driver, DriverCall& call, double torque) {
  const double most = call.options.largest_knob_torque;
  const double limited = std::isfinite(torque) ? std::clamp(torque, -most, most) : 0.0;
  const bool asks = driver.until_ask == 0;
  const bool older = driver.language == MotorKind::kOdrive5;
  driver.until_ask = asks ? (older ? kAskEvery : kAskEvery6) : driver.until_ask - 1;
  driver.asked = !asks   ? OdriveQuestion::kPlace
                 : older ? OdriveQuestion::kPlaceAndStatus
                         : OdriveQuestion::kState;
  driver.torque = limited;
  write(driver, call, encode_odrive_step(kAxis, limited, driver.asked).view());
}

void take_feedback(OdriveDriver& driver, DriverCall& call, const OdriveFeedback& feedback) {
  heard(driver, call);
  driver.phase = OdrivePhase::kLive;
  set_state(call, DeviceState::kLive);
  const Wrench wrench = publish_pose(call, knob_pose(feedback.position), 0);
  step(driver, call, wrench.torque.y);
}

/// Whether what it says of its place counts.
bool obeys(const OdriveDriver& driver) {
  return driver.phase == OdrivePhase::kLive ||
         (driver.phase == OdrivePhase::kSettingUp && driver.at > kSetUp.size());
}

/// What it says of itself. Its errors come from a cause that somebody has to remove, or it would
/// take hold again by itself; but it is set up anew where all that happened is that this machine
/// was too busy to feed it.
void take_status(OdriveDriver& driver, DriverCall& call, const OdriveStatus& status) {
  const bool lags = call.now - driver.set_up_at < kArms;
  if (status.errors == 0 && (status.state == kOdriveClosedLoop || lags)) {
    return;
  }
  call.report.sample.motor_errors = status.errors;
  call.report.sample.motor = driver.language;
  again_later(driver, call, DeviceTrouble::kMotorError);
  if (!only_unfed(driver.language, status.errors)) {
    driver.last_words = kLastWords;
    give_up(driver, call, DeviceTrouble::kMotorError);
  }
}

/// A number in place of a place: how an axis with firmware 0.6 is.
void take_number(OdriveDriver& driver, DriverCall& call, std::uint32_t number) {
  heard(driver, call);
  const bool lags = call.now - driver.set_up_at < kArms;
  if (driver.asked == OdriveQuestion::kReason) {
    take_status(driver, call, {number, 0});
  } else if (number == kOdriveClosedLoop || lags) {
    driver.asked = OdriveQuestion::kPlace;
    write(driver, call, encode_odrive_step(kAxis, driver.torque).view());
  } else {
    driver.asked = OdriveQuestion::kReason;
    write(driver, call, encode_odrive_step(kAxis, 0.0, driver.asked).view());
  }
}

/// Its firmware's version, before a line that another one might read otherwise.
void take_version(OdriveDriver& driver, DriverCall& call, Bytes bytes) {
  const std::size_t answers = driver.stream.version_lines;
  const auto version = take_odrive_version(driver.stream, text_of(bytes));
  const auto language = version ? language_of(*version) : std::nullopt;
  if (language) {
    driver.language = *language;
    driver.stream = {};
    driver.phase = OdrivePhase::kSettingUp;
    driver.heard_at = call.now;
    write(driver, call, kSetUp[driver.at++]);
    call.report.wake_at = call.now + kLost;
  } else if (version) {
    give_up(driver, call, DeviceTrouble::kWrongFirmware);
  } else if (driver.stream.version_lines != answers) {
    write(driver, call, kOdriveVersionQuestions[driver.stream.version_lines]);
  }
}

void take_bytes(OdriveDriver& driver, DriverCall& call, Bytes bytes) {
  if (driver.phase == OdrivePhase::kAskingVersion) {
    take_version(driver, call, bytes);
    return;
  }
  const auto feedback = take_odrive_bytes(driver.stream, text_of(bytes));
  const auto status = std::exchange(driver.stream.status, std::nullopt);
  if (status && driver.phase == OdrivePhase::kLive && driver.language == MotorKind::kOdrive5) {
    take_status(driver, call, *status);
  }
  const auto number = std::exchange(driver.stream.number, std::nullopt);
  if (number && driver.phase == OdrivePhase::kLive && driver.language == MotorKind::kOdrive6) {
    take_number(driver, call, *number);
    return;
  }
  if (feedback && obeys(driver)) {
    take_feedback(driver, call, *feedback);
  } else if (!bytes.empty() && !status && driver.stream.numbers == 0 &&
             driver.stream.line.size == 0) {
    call.report.counts.garbage += 1;
  }
}

void take_claim(OdriveDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (take_serial_claim(driver, call, event)) {
    driver.phase = OdrivePhase::kAskingVersion;
    write(driver, call, kOdriveVersionQuestions[0]);
  }
}

/// A line of the set-up has gone out: the next, and after the last the first step.
void go_on(OdriveDriver& driver, DriverCall& call) {
  if (driver.at < kSetUp.size()) {
    write(driver, call, kSetUp[driver.at++]);
  } else if (driver.at == kSetUp.size()) {
    driver.at += 1;
    driver.set_up_at = call.now;
    let_go(driver, call);
    call.report.wake_at = call.now + kSilence;
  }
}

}  // namespace

void let_go(OdriveDriver& driver, DriverCall& call) {
  let_go_through(driver.writes, call, bytes_of(encode_odrive_step(kAxis, 0.0).view()));
}

void again_later(OdriveDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go_through(driver.writes, call, bytes_of(kIdle));
  driver.phase = OdrivePhase::kClaiming;
  retry_later(call, trouble);
}

void begin(OdriveDriver& driver, DriverCall& call) {
  driver = fresh(driver);
  describe_knob(call, 8192.0);  // its usual encoder's
  claim_serial(driver, call);
}

void take(OdriveDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.job == UsbJob::kWrite) {
    const bool owed = take_write(driver.writes, call, event);
    if (driver.last_words > 0) {
      driver.last_words -= 1;
      write_through(driver.writes, call, bytes_of(kIdle));
    } else if (owed) {
      let_go(driver, call);
    } else if (driver.phase == OdrivePhase::kSettingUp) {
      go_on(driver, call);
    }
    return;
  }
  if (driver.phase == OdrivePhase::kNone) {
    return;
  }
  if (event.job == UsbJob::kClaim) {
    take_claim(driver, call, event);
    return;
  }
  take_read_of(driver, call, event, [&](Bytes bytes) { take_bytes(driver, call, bytes); });
}

void wake(OdriveDriver& driver, DriverCall& call) {
  wake_motors(driver, call);
}

void rest(OdriveDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == OdrivePhase::kSettingUp || driver.phase == OdrivePhase::kLive) {
    write_last(driver.writes, call, bytes_of(kIdle));
  }
  driver.phase = OdrivePhase::kNone;
}

}  // namespace torsion::engine
