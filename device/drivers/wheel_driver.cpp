#include "device/drivers/wheel_driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "device/drivers/hid_requests.hpp"

namespace torsion::engine {
namespace {

constexpr double kEffectTime = 0.05;        // s: after that the wheel is without torque by itself
constexpr double kStartAgain = 0.02;        // s
constexpr double kSettleTime = 0.05;        // s: after a reset
constexpr double kPing = 1.5e-3;            // s: without a word of it, then it is asked for one
constexpr double kSayAgain = 5e-4;          // s: that it is to let go
constexpr double kNoAnswer = 3.5e-3;        // s: without one all the same
constexpr double kShortestInterval = 1e-3;  // s
constexpr double kPause = 0.02;             // s: a longer one is no interval of its reports

bool may_be_wheel(const UsbInterface& interface) {
  return interface.device_class == kHidClass &&
         find_endpoint(interface, UsbEndpointKind::kInterrupt, kUsbIn) != nullptr &&
         find_endpoint(interface, UsbEndpointKind::kInterrupt, 0) != nullptr;
}

const UsbInterface& interface_of(const WheelDriver& driver, const DriverCall& call) {
  return call.identity.interfaces[driver.candidate];
}

/// Claims the next interface from driver.candidate on that may be a wheel's.
void claim_next(WheelDriver& driver, DriverCall& call) {
  const auto& interfaces = call.identity.interfaces;
  while (driver.candidate < interfaces.size() && !may_be_wheel(interfaces[driver.candidate])) {
    driver.candidate += 1;
  }
  if (driver.candidate == interfaces.size()) {
    give_up(driver, call, DeviceTrouble::kNotUnderstood);
    return;
  }
  driver.phase = WheelPhase::kClaiming;
  const UsbInterface& interface = interface_of(driver, call);
  claim_for(driver, call, find_endpoint(interface, UsbEndpointKind::kInterrupt, kUsbIn),
            find_endpoint(interface, UsbEndpointKind::kInterrupt, 0), interface.number);
}

double largest_torque(const DriverCall& call) {
  return std::min(call.options.largest_knob_torque, call.options.wheel_torque);
}

void describe_wheel(const WheelDriver& driver, DriverCall& call) {
  const double counts = static_cast<double>(driver.layout.turn.logical_max) -
                        static_cast<double>(driver.layout.turn.logical_min);
  describe_knob(call, counts * 2.0 * std::numbers::pi / call.options.wheel_range);
  DeviceSample& sample = call.report.sample;
  sample.traits.largest_torque = largest_torque(call);
  set_cautious_heat(sample.traits);
  if (largest_torque(call) == 0.0) {
    sample.actuated = kNoAxes;
  }
}

void go_live(WheelDriver& driver, DriverCall& call) {
  driver.phase = WheelPhase::kLive;
  driver.was_enabled = false;
  driver.was_powered = false;
  driver.heard_at = call.now;
  driver.taken_at = call.now;
  driver.started_at = -kNever;  // its effect begins with the first step
  set_state(call, DeviceState::kLive);
  call.report.wake_at = call.now;
}

/// Some say where they are when they are asked, some ten times a second, some when they turn.
void ask_place(WheelDriver& driver, DriverCall& call) {
  driver.phase = WheelPhase::kPlacing;
  driver.heard_at = call.now;
  call.report.wake_at = kNever;
  set_state(call, DeviceState::kStarting, DeviceTrouble::kNotMoved);
  get_hid_report(call.requests, interface_of(driver, call).number, HidReportKind::kInput,
                 driver.layout.place.id, driver.layout.place.size);
}

/// Writes a packet of the set-up. @return false where the wheel has no such report
bool write_set_up(WheelDriver& driver, DriverCall& call, const WheelPacket& packet) {
  if (packet.size > 0) {
    write_through(driver.writes, call, packet.data(), true);
  }
  return packet.size > 0;
}

void ask_block(WheelDriver& driver, DriverCall& call) {
  const WheelReport& load = driver.layout.load;
  get_hid_report(call.requests, interface_of(driver, call).number, HidReportKind::kFeature, load.id,
                 load.size);
}

/// One packet of the set-up after the other; what a wheel has not is left out.
void set_up(WheelDriver& driver, DriverCall& call, WheelPhase phase) {
  driver.phase = phase;
  driver.heard_at = call.now;
  call.report.wake_at = call.now + kLost;
  switch (phase) {
    case WheelPhase::kResetting:
      if (!write_set_up(driver, call, encode_wheel_reset(driver.layout))) {
        set_up(driver, call, WheelPhase::kEnabling);
      }
      break;
    case WheelPhase::kSettling:
      call.report.wake_at = call.now + kSettleTime;
      break;
    case WheelPhase::kEnabling:
      write_set_up(driver, call, encode_wheel_enable(driver.layout));
      break;
    case WheelPhase::kGain:
      if (!write_set_up(driver, call, encode_wheel_gain(driver.layout))) {
        set_up(driver, call, WheelPhase::kCreating);
      }
      break;
    case WheelPhase::kCreating:
      set_hid_report(call.requests, interface_of(driver, call).number, HidReportKind::kFeature,
                     driver.layout.create.id, encode_wheel_create(driver.layout).data());
      break;
    case WheelPhase::kLoading:
    case WheelPhase::kConfirming:
      ask_block(driver, call);
      break;
    case WheelPhase::kDescribing:
      write_set_up(driver, call, encode_wheel_effect(driver.layout, driver.block, kEffectTime));
      break;
    case WheelPhase::kZeroing:
      write_set_up(driver, call, encode_wheel_torque(driver.layout, driver.block, 0.0));
      break;
    default:
      driver.has_place ? go_live(driver, call) : ask_place(driver, call);
      break;
  }
}

/// The set-up's last packet is through.
void set_up_further(WheelDriver& driver, DriverCall& call) {
  set_up(driver, call, static_cast<WheelPhase>(static_cast<std::uint8_t>(driver.phase) + 1));
}

bool sets_up(const WheelDriver& driver) {
  return driver.phase > WheelPhase::kAsking && driver.phase < WheelPhase::kPlacing;
}

void take_descriptor(WheelDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.status != UsbStatus::kCompleted && event.status != UsbStatus::kStall) {
    again_later(driver, call, DeviceTrouble::kSilent);
    return;
  }
  const auto reports = event.status == UsbStatus::kCompleted && !event.bytes.empty()
                           ? parse_hid_descriptor(event.bytes)
                           : std::nullopt;
  const auto layout = reports ? wheel_layout(*reports) : std::nullopt;
  if (!layout) {
    release_usb(call.requests, interface_of(driver, call).number);
    driver.candidate += 1;
    claim_next(driver, call);
    return;
  }
  driver.layout = *layout;
  describe_wheel(driver, call);
  keep_reading(driver.reads, call);
  if (largest_torque(call) > 0.0) {
    set_up(driver, call, WheelPhase::kResetting);
  } else {
    ask_place(driver, call);
  }
}

/// When it would have reported by if it turned: s.
double stands_at(const WheelDriver& driver) {
  return driver.published_at + 1.2 * driver.interval;
}

/// Wakes when the next thing has to be done though nothing will have come.
void plan_check(const WheelDriver& driver, DriverCall& call) {
  double next = stands_at(driver);
  if (driver.block != 0) {
    next = std::min(next, driver.heard_at + (driver.pinging ? kNoAnswer : kPing));
  }
  call.report.wake_at = std::max(next, call.now);
}

/// Of a wheel that was asked whether it is there.
void take_answer(WheelDriver& driver, DriverCall& call, const UsbEvent& event) {
  const bool done = event.status == UsbStatus::kCompleted;
  if (!done && event.status != UsbStatus::kStall) {
    return;
  }
  driver.heard_at = call.now;
  const bool knows = done && decode_wheel_load(driver.layout, event.bytes) == driver.block;
  if (driver.phase == WheelPhase::kLive && driver.knows_block && !knows) {
    again_later(driver, call, DeviceTrouble::kSilent);  // it was without power
    return;
  }
  if (driver.phase == WheelPhase::kLive) {
    plan_check(driver, call);
  }
}

/// The torque of one step, or that the effect goes on: one step in 20 says so in its place.
void step(WheelDriver& driver, DriverCall& call, double torque) {
  if (driver.block == 0 || driver.writes.under_way) {
    return;
  }
  if (call.now - driver.started_at >= kStartAgain) {
    driver.started_at = call.now;
    write_through(driver.writes, call, encode_wheel_start(driver.layout, driver.block).data());
    return;
  }
  const double most = largest_torque(call);
  const double sign = call.options.wheel_reversed ? -1.0 : 1.0;
  const double within = std::isfinite(torque) ? std::clamp(torque, -most, most) : 0.0;
  write_through(
      driver.writes, call,
      encode_wheel_torque(driver.layout, driver.block, sign * within / call.options.wheel_torque)
          .data());
}

/// It takes no packets, or says nothing: what is known of it is too old to push.
bool is_stuck(const WheelDriver& driver, const DriverCall& call) {
  const bool waits = driver.writes.under_way && call.now - driver.writes.asked_at > kSilence;
  return driver.block != 0 && (driver.refused || waits || call.now >= driver.heard_at + kNoAnswer);
}

void publish(WheelDriver& driver, DriverCall& call) {
  driver.published_at = call.now;
  // Clockwise, to the right, is positive for a wheel and negative about an axis that comes to you.
  const double turns =
      -0.5 * driver.state.turn * call.options.wheel_range / (2.0 * std::numbers::pi);
  const Wrench wrench = publish_pose(call, knob_pose(turns), driver.state.buttons);
  step(driver, call, wrench.torque.y);
}

/// Wheels report when they turn, some of them seldom: how often tells how old a place may be.
void learn_interval(WheelDriver& driver, const DriverCall& call, std::int32_t before) {
  const std::int64_t step = std::abs(std::int64_t{driver.state.count} - before);
  const double interval = call.now - driver.reported_at;
  if (step == 0 || interval > kPause) {
    return;
  }
  driver.smallest_step =
      static_cast<std::int32_t>(std::min<std::int64_t>(driver.smallest_step, step));
  // It has passed counts on its way and did not report them: this is how often it can.
  const bool passed = step >= 3 * std::int64_t{driver.smallest_step};
  const double share = interval < driver.interval ? 0.2 : passed ? 0.05 : 0.0;
  driver.interval =
      std::max(kShortestInterval, driver.interval + share * (interval - driver.interval));
}

/// Its motor was switched off, and not by us. @return true where that has happened
bool lost_motor(WheelDriver& driver, DriverCall& call) {
  const bool off = driver.was_enabled && !driver.state.enabled;
  const bool dead = driver.was_powered && !driver.state.powered;
  driver.was_enabled = driver.state.enabled;
  driver.was_powered = driver.state.powered;
  if (driver.block == 0 || (!off && !dead)) {
    return false;
  }
  DeviceSample& sample = call.report.sample;
  sample.motor = MotorKind::kWheel;
  sample.motor_errors = dead ? kWheelWithoutPower : kWheelSwitchedOff;
  driver.last_words = kLastWords;
  let_go(driver, call);
  give_up(driver, call, DeviceTrouble::kMotorError);
  return true;
}

void take_report(WheelDriver& driver, DriverCall& call, Bytes bytes) {
  const std::int32_t before = driver.state.count;
  if (!take_wheel_report(driver.layout, bytes, driver.state)) {
    call.report.counts.garbage += is_of_place(driver.layout, bytes) ? 1U : 0U;
    return;
  }
  driver.has_place = driver.has_place || is_of_place(driver.layout, bytes);
  if (driver.phase == WheelPhase::kPlacing && driver.has_place) {
    go_live(driver, call);
  }
  if (driver.phase != WheelPhase::kLive) {
    return;
  }
  driver.heard_at = call.now;
  if (lost_motor(driver, call) || !is_of_place(driver.layout, bytes)) {
    return;
  }
  learn_interval(driver, call, before);
  driver.reported_at = call.now;
  if (!is_stuck(driver, call)) {
    publish(driver, call);
  }
}

void take_control(WheelDriver& driver, DriverCall& call, const UsbEvent& event) {
  const bool done = event.status == UsbStatus::kCompleted;
  if (driver.phase == WheelPhase::kAsking && event.setup.request == kGetHidDescriptor) {
    take_descriptor(driver, call, event);
  } else if (driver.phase == WheelPhase::kCreating && event.setup.request == kSetHidReport) {
    done ? set_up_further(driver, call) : again_later(driver, call, DeviceTrouble::kSilent);
  } else if (driver.phase == WheelPhase::kLoading && event.setup.request == kGetHidReport) {
    const auto block = done ? decode_wheel_load(driver.layout, event.bytes) : std::nullopt;
    if (block) {
      driver.block = *block;
      set_up_further(driver, call);
    } else {
      again_later(driver, call, DeviceTrouble::kNotUnderstood);
    }
  } else if (driver.phase == WheelPhase::kConfirming && event.setup.request == kGetHidReport) {
    driver.knows_block = done && decode_wheel_load(driver.layout, event.bytes) == driver.block;
    set_up_further(driver, call);
  } else if (driver.phase == WheelPhase::kPlacing && event.setup.request == kGetHidReport) {
    if (done) {
      take_report(driver, call, event.bytes);
    }
  } else if (event.setup.request == kGetHidReport && driver.pinging) {
    driver.pinging = false;
    take_answer(driver, call, event);
  }
}

/// Each packet of the set-up is sent twice: wheels are busy while they reset, and some lose one.
void take_end_of_set_up(WheelDriver& driver, DriverCall& call, bool done) {
  if (!done) {
    again_later(driver, call, DeviceTrouble::kSilent);
    return;
  }
  driver.repeated = !driver.repeated;
  if (driver.repeated) {
    set_up(driver, call, driver.phase);
  } else {
    set_up_further(driver, call);
  }
}

void take_end_of_write(WheelDriver& driver, DriverCall& call, const UsbEvent& event) {
  const bool owed = take_write(driver.writes, call, event);
  const bool done = event.status == UsbStatus::kCompleted;
  driver.refused = !done;
  driver.taken_at = done ? call.now : driver.taken_at;
  if (driver.last_words > 0) {
    driver.last_words -= 1;
    let_go(driver, call);
  } else if (sets_up(driver)) {
    take_end_of_set_up(driver, call, done);
  } else if (owed || (!done && driver.phase == WheelPhase::kLive)) {
    let_go(driver, call);
  }
}

/// What has to be done at some time though nothing has come.
void check(WheelDriver& driver, DriverCall& call) {
  const bool silent = call.now - driver.heard_at > kLost || call.now - driver.taken_at > kLost;
  if (driver.block != 0 && silent) {
    again_later(driver, call, DeviceTrouble::kSilent);
    return;
  }
  if (driver.block != 0 && !driver.pinging && call.now >= driver.heard_at + kPing) {
    // Any question that it has answered before will do.
    driver.pinging = true;
    ask_block(driver, call);
  }
  if (is_stuck(driver, call)) {
    if (!driver.writes.under_way) {
      let_go(driver, call);
    }
    call.report.wake_at = call.now + kSayAgain;
    return;
  }
  if (call.now >= stands_at(driver)) {
    publish(driver, call);
  }
  plan_check(driver, call);
}

}  // namespace

void let_go(WheelDriver& driver, DriverCall& call) {
  if (driver.block != 0) {
    let_go_through(driver.writes, call,
                   encode_wheel_torque(driver.layout, driver.block, 0.0).data());
  }
}

void again_later(WheelDriver& driver, DriverCall& call, DeviceTrouble trouble) {
  let_go(driver, call);
  driver.phase = WheelPhase::kClaiming;
  retry_later(call, trouble);
}

void begin(WheelDriver& driver, DriverCall& call) {
  driver = fresh(driver);
  call.report.sample.pose = {};
  claim_next(driver, call);
}

void take(WheelDriver& driver, DriverCall& call, const UsbEvent& event) {
  if (event.job == UsbJob::kWrite) {
    take_end_of_write(driver, call, event);
    return;
  }
  if (driver.phase == WheelPhase::kNone) {
    return;
  }
  if (event.job == UsbJob::kClaim && driver.phase == WheelPhase::kClaiming) {
    if (event.status != UsbStatus::kCompleted) {
      retry_claim(call, event);
      return;
    }
    driver.phase = WheelPhase::kAsking;
    ask_report_descriptor(call.requests, interface_of(driver, call).number);
  } else if (event.job == UsbJob::kControl) {
    take_control(driver, call, event);
  } else {
    take_read_of(driver, call, event, [&](Bytes bytes) { take_report(driver, call, bytes); });
  }
}

void wake(WheelDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.phase == WheelPhase::kClaiming) {
    begin(driver, call);
  } else if (driver.phase == WheelPhase::kSettling) {
    set_up_further(driver, call);
  } else if (driver.phase == WheelPhase::kLive) {
    check(driver, call);
  } else if (sets_up(driver)) {
    again_later(driver, call, DeviceTrouble::kSilent);
  }
}

void rest(WheelDriver& driver, DriverCall& call) {
  call.report.wake_at = kNever;
  if (driver.block != 0 && driver.phase == WheelPhase::kLive) {
    write_last(driver.writes, call, encode_wheel_torque(driver.layout, driver.block, 0.0).data());
    write_usb(call.requests, driver.writes.endpoint,
              encode_wheel_stop(driver.layout, driver.block).data());
  }
  driver.phase = WheelPhase::kNone;
}

}  // namespace torsion::engine
