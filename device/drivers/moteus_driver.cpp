#include "device/drivers/moteus_driver.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace torsion::engine {
namespace {

constexpr double kWatchdog = 0.05;  // s: it stops by itself when nothing comes for as long

Bytes bytes_of(const MoteusLine& line) {
  return {reinterpret_cast<const std::uint8_t*>(line.text.data()), line.size};
}

void step(MoteusDriver& driver, DriverCall& call, double torque) {
  write_through(driver.writes, call,
                bytes_of(encode_moteus_step(torque, call.options.largest_knob_torque, kWatchdog)));
}

/// It has no torque, by itself. A time-out says that this machine was too busy, and it is set up
/// anew; the cause of a fault somebody has to remove.
void take_trouble(MoteusDriver& driver, DriverCall& call, const MoteusReply& reply) {
  const bool unfed = reply.mode == static_cast<std::uint8_t>(MoteusMode::kTimeout);
  DeviceSample& sample = call.report.sample;
  sample.motor = MotorKind::kMoteus;
  sample.motor_errors = unfed ? kMoteusUnfed : reply.fault;
  again_later(driver, call, DeviceTrouble::kMotorError);
  if (!unfed) {
    driver.last_words = kLastWords;
    give_up(driver, call, DeviceTrouble::kMotorError);
  }
}

void take_reply(MoteusDriver& driver, DriverCall& call, const MoteusReply& reply) {
  heard(driver, call);
  const bool obeys = reply.mode == static_cast<std::uint8_t>(MoteusMode::kPosition);
  if (driver.phase == MoteusPhase::kStopping) {
    driver.phase = MoteusPhase::kLive;
    driver.set_up_at = call.now;
    step(driver, call, 0.0);
    return;
  }
  const bool lags = call.now - driver.set_up_at < kArms &&
                    reply.mode == static_cast<std::uint8_t>(MoteusMode::kStopped);
  if (!obeys && !lags) {
    take_trouble(driver, call, reply);
    return;
  }
  if (!obeys) {
    step(driver, call, 0.0);
    return;
  }
  set_state(call, DeviceState::kLive);
  const Wrench wrench = publish_pose(call, knob_pose(reply.position), 0);
  step(driver, call, wrench.torque.y);
}

void take_line(MoteusDriver& driver, DriverCall& call, std::string_view line) {
  if (driver.phase == MoteusPhase::kAskingVersion) {
    const auto map = decode_moteus_register_map(line);
    if (map && *map == kMoteusRegisterMap) {
      driver.phase = MoteusPhase::kStopping;
      driver.heard_at = call.now;
      write_through(driver.writes, call, bytes_of(encode_moteus_stop()));
      call.report.wake_at = call.now + kLost;
    } else if (map) {
      give_up(driver, call, DeviceTrouble::kWrongFirmware);
    }
    return;  // the adapter says OK to each line, or ERR where its bus was on
  }
  if (driver.phase != MoteusPhase::kStopping && driver.phase != MoteusPhase::kLive) {
    return;
  }
  const auto reply = decode_moteus_reply(line);
  if (reply) {
    take_reply(driver, call, *reply);
  } else if (line != "OK") {
    call.report.counts.garbage += 1;
  }
}

}  // namespace

void let_go(MoteusDriver& driver, DriverCall& call) {
  let_go_through(driver.writes, call,
                 bytes_of(encode_moteus_step(0.0, call.options.largest_knob_torque, kWatchdog)));
}

void again_later(MoteusDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go_through(driver.writes, call, bytes_of(encode_moteus_stop()));
  driver.phase = MoteusPhase::kClaiming;
  retry_later(call, trouble);
}

void begin(MoteusDriver& driver, DriverCall& call) {
  driver = fresh(driver);
  describe_knob(call, 16384.0);  // its encoder's: 14 bits
  claim_serial(driver, call);
}

void take(MoteusDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.job == UsbJob::kWrite) {
    const bool owed = take_write(driver.writes, call, event);
    if (driver.last_words > 0) {
      driver.last_words -= 1;
      write_through(driver.writes, call, bytes_of(encode_moteus_stop()));
    } else if (owed) {
      let_go(driver, call);
    }
    return;
  }
  if (driver.phase == MoteusPhase::kNone) {
    return;
  }
  if (event.job == UsbJob::kClaim) {
    if (take_serial_claim(driver, call, event)) {
      driver.phase = MoteusPhase::kAskingVersion;
      write_through(
          driver.writes, call,
          {reinterpret_cast<const std::uint8_t*>(kMoteusOpening.data()), kMoteusOpening.size()});
    }
    return;
  }
  take_read_of(driver, call, event, [&](Bytes bytes) {
    take_moteus_bytes(driver.stream, {reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                      [&](std::string_view line) { take_line(driver, call, line); });
  });
}

void wake(MoteusDriver& driver, DriverCall& call) {
  wake_motors(driver, call);
}

void rest(MoteusDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == MoteusPhase::kStopping || driver.phase == MoteusPhase::kLive) {
    write_last(driver.writes, call, bytes_of(encode_moteus_stop()));
  }
  driver.phase = MoteusPhase::kNone;
}

}  // namespace torsion::engine
