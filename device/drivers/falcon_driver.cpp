#include "device/drivers/falcon_driver.hpp"

#include <algorithm>

namespace torsion::engine {
namespace {

const glm::dvec3 kCentre(0.0, 0.0, 0.115);  // m, device axes: of the workspace
constexpr double kAnswer = 0.1;             // s: for an answer in set-up
constexpr std::uint32_t kAsks = 3;
constexpr std::uint32_t kGreetings = 100;
constexpr std::uint32_t kLoads = 3;
constexpr std::uint8_t kAllHomed = 7;

std::array<std::uint8_t, kFalconPacket> packet_of(const FalconDriver& driver,
                                                  const std::array<std::int16_t, 3>& motors) {
  FalconOutput output;
  output.motors = motors;
  // Asks for the encoders' zeros, and has to be in every packet for them to stay (libnifalcon,
  // FalconFirmware.h).
  output.homing = true;
  output.green = driver.phase == FalconPhase::kLive;
  output.red = !output.green;
  return encode_falcon(output);
}

void ask(FalconDriver& driver, DriverCall& call) {
  driver.phase = FalconPhase::kAsking;
  driver.stream = {};
  driver.tries += 1;
  let_go(driver, call);
  call.report.wake_at = call.now + kAnswer;
}

void say(FalconDriver& driver, DriverCall& call, const FalconPhrase& phrase) {
  driver.echo = {};
  driver.tries += 1;
  write_through(driver.writes, call, Bytes(phrase.said).first(phrase.said_size), true);
  call.report.wake_at = call.now + kAnswer;
}

Bytes piece_of(const FalconDriver& driver, const DriverCall& call) {
  const auto rest = call.options.falcon_firmware.subspan(driver.at);
  return rest.first(std::min(kFirmwarePiece, rest.size()));
}

std::span<const UsbSetup> controls_of(FalconPhase phase) {
  switch (phase) {
    case FalconPhase::kNormalSetUp:
      return falcon_normal_set_up();
    case FalconPhase::kLoadingSetUp:
      return falcon_loading_set_up();
    case FalconPhase::kWritingSetUp:
      return falcon_writing_set_up();
    default:
      return {};
  }
}

/// Asks for the next control of the phase, or goes on to the phase after it.
void next_control(FalconDriver& driver, DriverCall& call) {
  const auto controls = controls_of(driver.phase);
  if (driver.at < controls.size()) {
    control_usb(call.requests, controls[driver.at]);
    return;
  }
  driver.at = 0;
  driver.tries = 0;
  keep_reading(driver.reads, call);
  if (driver.phase == FalconPhase::kNormalSetUp) {
    ask(driver, call);
  } else if (driver.phase == FalconPhase::kLoadingSetUp) {
    driver.phase = FalconPhase::kGreeting;
    say(driver, call, kFalconGreeting);
  } else {
    driver.phase = FalconPhase::kReady;
    say(driver, call, kFalconReady);
  }
}

void start_controls(FalconDriver& driver, DriverCall& call, FalconPhase phase) {
  driver.phase = phase;
  driver.at = 0;
  call.report.wake_at = kNever;
  next_control(driver, call);
}

/// It does not answer as a Falcon with firmware does.
void load_firmware(FalconDriver& driver, DriverCall& call) {
  if (call.options.falcon_firmware.empty()) {
    // It may have been busy: somebody who switches it off and on wants it to be found again.
    again_later(driver, call, DeviceTrouble::kNoFirmware);
  } else if (driver.loads == kLoads) {
    give_up(driver, call, DeviceTrouble::kBadFirmware);
  } else {
    driver.loads += 1;
    start_controls(driver, call, FalconPhase::kLoadingSetUp);
  }
}

void write_piece(FalconDriver& driver, DriverCall& call) {
  driver.echo = {};
  write_through(driver.writes, call, piece_of(driver, call), true);
  call.report.wake_at = call.now + kAnswer;
}

/// Bytes while firmware is loaded.
void take_talk(FalconDriver& driver, DriverCall& call, Bytes bytes) {
  take_echo(driver.echo, bytes);
  if (driver.phase == FalconPhase::kWriting) {
    const Bytes piece = piece_of(driver, call);
    if (!ends_with(driver.echo, piece)) {
      return;
    }
    driver.at += piece.size();
    if (driver.at < call.options.falcon_firmware.size()) {
      write_piece(driver, call);
    } else {
      start_controls(driver, call, FalconPhase::kNormalSetUp);
    }
    return;
  }
  const FalconPhrase& phrase =
      driver.phase == FalconPhase::kGreeting ? kFalconGreeting : kFalconReady;
  if (!ends_with(driver.echo, Bytes(phrase.answer).first(phrase.answer_size))) {
    return;
  }
  if (driver.phase == FalconPhase::kGreeting) {
    start_controls(driver, call, FalconPhase::kWritingSetUp);
  } else {
    driver.phase = FalconPhase::kWriting;
    driver.at = 0;
    write_piece(driver, call);
  }
}

/// A packet of the encoders: the pose, and the force that goes with it.
void take_packet(FalconDriver& driver, DriverCall& call, const FalconInput& input) {
  heard(driver, call);
  if (input.homed != kAllHomed) {
    driver.phase = FalconPhase::kHoming;
    set_state(call, DeviceState::kStarting, DeviceTrouble::kNotHomed);
    let_go(driver, call);
    return;
  }
  if (driver.phase != FalconPhase::kLive) {
    driver.phase = FalconPhase::kLive;
    driver.place = kCentre;
    set_state(call, DeviceState::kLive);
  }
  if (const auto place = falcon_forward(falcon_joint_angles(input), driver.place)) {
    driver.place = *place;
  } else {
    // Nobody knows where it is: no force there.
    call.report.counts.garbage += 1;
    let_go(driver, call);
    return;
  }
  const Wrench wrench =
      publish_pose(call, {driver.place - kCentre, glm::dquat(1.0, 0.0, 0.0, 0.0)}, input.buttons);
  write_through(driver.writes, call, packet_of(driver, falcon_motors(driver.place, wrench.force)));
}

void take_bytes(FalconDriver& driver, DriverCall& call, Bytes bytes) {
  switch (driver.phase) {
    case FalconPhase::kGreeting:
    case FalconPhase::kReady:
    case FalconPhase::kWriting:
      take_talk(driver, call, bytes);
      break;
    case FalconPhase::kAsking:
    case FalconPhase::kHoming:
    case FalconPhase::kLive: {
      constexpr std::size_t kStatusOnly = 2;
      const auto input = take_ftdi_packet(driver.stream, bytes);
      if (input) {
        take_packet(driver, call, *input);
      } else if (bytes.size() > kStatusOnly && driver.stream.count == 0) {
        call.report.counts.garbage += 1;
      }
      break;
    }
    default:
      break;
  }
}

}  // namespace

void let_go(FalconDriver& driver, DriverCall& call) {
  let_go_through(driver.writes, call, packet_of(driver, {}));
}

void again_later(FalconDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go(driver, call);
  driver.phase = FalconPhase::kClaiming;
  retry_later(call, trouble);
}

void begin(FalconDriver& driver, DriverCall& call) {
  const std::uint32_t loads = driver.loads;
  driver = fresh(driver);
  driver.loads = loads;
  DeviceSample& sample = call.report.sample;
  sample.sensed = kTranslationAxes;
  sample.actuated = kTranslationAxes;
  sample.traits = {};
  sample.traits.encoder_step = 64e-6;  // m: 0.0364 degrees of a joint at 0.1 m
  sample.traits.largest_force = 8.0;   // N, as CHAI3D has it
  set_cautious_heat(sample.traits);
  if (call.identity.interfaces.empty()) {
    give_up(driver, call, DeviceTrouble::kNotUnderstood);
    return;
  }
  const UsbInterface& interface = call.identity.interfaces.front();
  claim_for(driver, call, find_endpoint(interface, UsbEndpointKind::kBulk, kUsbIn),
            find_endpoint(interface, UsbEndpointKind::kBulk, 0), interface.number);
}

void take(FalconDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.job == UsbJob::kClaim) {
    if (driver.phase == FalconPhase::kClaiming && event.status == UsbStatus::kCompleted) {
      start_controls(driver, call, FalconPhase::kNormalSetUp);
    } else if (driver.phase == FalconPhase::kClaiming) {
      retry_claim(call, event);
    }
    return;
  }
  if (event.job == UsbJob::kWrite) {
    if (take_write(driver.writes, call, event)) {
      let_go(driver, call);
    }
    return;
  }
  if (event.job == UsbJob::kControl) {
    if (controls_of(driver.phase).empty()) {
      return;
    }
    if (event.status != UsbStatus::kCompleted) {
      again_later(driver, call, DeviceTrouble::kSilent);
      return;
    }
    driver.at += 1;
    next_control(driver, call);
    return;
  }
  take_read_of(driver, call, event, [&](Bytes bytes) { take_bytes(driver, call, bytes); });
}

void wake(FalconDriver& driver, DriverCall& call) {
  switch (driver.phase) {
    case FalconPhase::kAsking:
      if (driver.tries < kAsks) {
        ask(driver, call);
      } else {
        load_firmware(driver, call);
      }
      break;
    case FalconPhase::kGreeting:
      if (driver.tries < kGreetings) {
        say(driver, call, kFalconGreeting);
      } else {
        load_firmware(driver, call);
      }
      break;
    case FalconPhase::kReady:    // said once only: a second one would be the firmware's first byte
    case FalconPhase::kWriting:  // it did not send the piece back
      load_firmware(driver, call);
      break;
    case FalconPhase::kNormalSetUp:
    case FalconPhase::kLoadingSetUp:
    case FalconPhase::kWritingSetUp:
      call.report.wake_at = kNever;  // a control is under way
      break;
    default:
      wake_motors(driver, call);
      break;
  }
}

void rest(FalconDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == FalconPhase::kLive || driver.phase == FalconPhase::kHoming) {
    write_last(driver.writes, call, packet_of(driver, {}));
  }
  driver.phase = FalconPhase::kNone;
}

}  // namespace torsion::engine
