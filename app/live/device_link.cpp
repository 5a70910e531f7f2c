#include "app/live/device_link.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/live/measured_traits.hpp"
#include "app/live/periodic_clock.hpp"
#include "app/live/realtime_mode.hpp"

namespace torsion::engine {
namespace {

constexpr std::string_view kGateway = "gateway";

double seconds(Nanoseconds time) {
  return 1e-9 * static_cast<double>(time);
}

GatewayState gateway_state(GuardState state) {
  switch (state) {
    case GuardState::kWaiting:
      return GatewayState::kWaiting;
    case GuardState::kChecking:
      return GatewayState::kChecking;
    case GuardState::kRising:
      return GatewayState::kRising;
    case GuardState::kLive:
      return GatewayState::kLive;
    case GuardState::kFalling:
      return GatewayState::kFalling;
    default:
      return GatewayState::kOff;
  }
}

}  // namespace

DeviceLink::DeviceLink(const Pose& tool) {
  side_.home = tool;
}

DeviceLink::~DeviceLink() = default;

std::unique_ptr<DeviceLink> DeviceLink::held_as(const DeviceChoice& choice, const Pose& tool) {
  auto link = std::make_unique<DeviceLink>(tool);
  GuardLimits& limits = link->side_.limits;
  limits.longest_silence = choice.longest_silence;
  // Who bears a silent physics for longer bears a device that is.
  limits.longest_gap = std::max(limits.longest_gap, choice.longest_silence);
  link->side_.hold = choice.hold;
  link->side_.safety = choice.safety;
  return link;
}

Result<Done> DeviceLink::start_usb(const DeviceChoice& choice, std::uint32_t kinds,
                                   SampleSink sink) {
  Result<std::vector<std::uint8_t>> firmware = load_firmware(choice.falcon_firmware);
  if (!firmware) {
    return firmware.error();
  }
  auto measured = load_measured_traits();
  if (!measured) {
    return measured.error();
  }
  firmware_ = std::move(firmware).value();
  UsbBusOptions options;
  options.loop = loop_of(choice, kinds, firmware_);
  options.loop.measured = measured.value();
  options.loop.turn_axis = turn_axis();
  options.on_start = [] {
    become_realtime();
  };
  auto bus = UsbBus::start(options, sink);
  if (!bus) {
    return bus.error();
  }
  bus_ = std::move(bus).value();
  return Done{};
}

Result<std::unique_ptr<DeviceLink>> DeviceLink::open_gateway(const DeviceChoice& choice,
                                                             const Pose& tool) {
  const Result<GatewayChoice> what = gateway_choice(choice.what);
  if (!what) {
    return what.error();
  }
  Result<GatewayOptions> options = gateway_options(choice, what.value().gateway);
  if (!options) {
    return options.error();
  }
  std::unique_ptr<DeviceLink> link = held_as(choice, tool);
  link->turn_buttons_ = choice.turn_buttons;
  if (what.value().knobs != 0) {
    link->knob_ = std::make_unique<JoinedKnob>();
    link->knob_->axis = link->turn_axis();
    const Result<Done> started =
        link->start_usb(choice, what.value().knobs,
                        {link->knob_.get(), [](void* knob, const DeviceSample& sample) {
                           return take_knob_sample(*static_cast<JoinedKnob*>(knob), sample);
                         }});
    if (!started) {
      return started.error();
    }
  }
  options.value().on_start = [] {
    become_realtime();
  };
  auto gateway = Gateway::start(std::move(options).value(), {{link.get(), on_client}, describe});
  if (!gateway) {
    return gateway.error();
  }
  link->gateway_ = std::move(gateway).value();
  return link;
}

Result<std::unique_ptr<DeviceLink>> DeviceLink::open(const DeviceChoice& choice, const Pose& tool) {
  if (choice.what.starts_with(kGateway)) {
    return open_gateway(choice, tool);
  }
  if (!choice.gateway_address.empty() || !choice.gateway_secret.empty()) {
    return Error{
        fmt::format("--device {}: --gateway-address and --gateway-secret are for "
                    "--device gateway",
                    choice.what)};
  }
  const Result<std::uint32_t> kinds = kinds_of(choice.what);
  if (!kinds) {
    return kinds.error();
  }
  std::unique_ptr<DeviceLink> link = held_as(choice, tool);
  const Result<Done> started = link->start_usb(choice, kinds.value(), {link.get(), on_sample});
  if (!started) {
    return started.error();
  }
  return link;
}

glm::dvec3 DeviceLink::turn_axis() const {
  return side_.home.rotation * glm::dvec3(0.0, 1.0, 0.0);
}

Wrench DeviceLink::on_client(void* context, const DeviceSample& said) {
  auto& link = *static_cast<DeviceLink*>(context);
  DeviceSample sample = said;
  if (link.knob_) {
    join_knob(*link.knob_, sample);
  }
  turn_by_buttons(link.button_turn_, link.turn_buttons_, link.turn_axis(), sample, sample.time);
  const Wrench wrench = link.take(sample);
  if (link.knob_) {
    ask_knob(*link.knob_, sample, wrench);
  }
  return wrench;
}

Wrench DeviceLink::on_sample(void* link, const DeviceSample& sample) {
  return static_cast<DeviceLink*>(link)->take(sample);
}

void DeviceLink::describe(void* link, GatewayAnswer& answer) {
  auto& self = *static_cast<DeviceLink*>(link);
  const HandleAnswer& physics = self.slot_.answer.front();
  answer.tool = physics.time_ns != 0 ? physics.tool : self.side_.home;
  answer.faults = physics.faults;
  answer.state = gateway_state(self.now_.guard);
}

void DeviceLink::carry(const MouseCarry& carry) {
  carries_.back() = carry;
  carries_.publish();
}

/// As if the device measured the mouse's way: smoothed, as a mouse moves in jumps, and no faster
/// than a hand is let.
void DeviceLink::add_carried(DeviceSample& sample) {
  constexpr double kFollowTime = 0.03;      // s
  constexpr double kLargestSpeed = 0.5;     // m/s
  constexpr double kLongestElapsed = 0.02;  // s
  constexpr std::uint32_t kCarried = 1U << 31U;
  carries_.refresh();
  const MouseCarry& carry = carries_.front();
  if ((sample.sensed & kTranslationAxes) != 0 || carry.stiffness == 0.0) {
    return;
  }
  const double elapsed = std::clamp(sample.time - carried_at_, 0.0, kLongestElapsed);
  carried_at_ = sample.time;
  const glm::dvec3 step = (carry.moved - carried_) * -std::expm1(-elapsed / kFollowTime);
  const double length = glm::length(step);
  const double most = kLargestSpeed * elapsed;
  carried_ += length > most ? step * (most / length) : step;
  sample.pose.position += carried_;
  sample.traits.largest_stiffness = carry.stiffness;
  sample.traits.largest_force = carry.largest_force;
  sample.epoch |= kCarried;  // from when it is carried on it has another coupling
}

Wrench DeviceLink::take(const DeviceSample& said) {
  DeviceSample sample = said;
  add_carried(sample);
  slot_.answer.refresh();
  const HandleAnswer& answer = slot_.answer.front();
  PhysicsResult result;
  result.any = answer.time_ns != 0;
  result.tool = answer.tool;
  result.contact = answer.contact;
  result.time = seconds(answer.time_ns);
  result.faulty = answer.faults != 0;
  const double now = seconds(monotonic_now());
  const HandleOutcome outcome = take_handle_sample(side_, sample, result, now);
  if (outcome.holds) {
    HandleSample& handle = slot_.sample.back();
    handle.pose = outcome.handle;
    handle.number = ++number_;
    handle.time_ns = static_cast<Nanoseconds>(1e9 * sample.time);
    handle.buttons = sample.buttons;
    handle.epoch = side_.couplings;
    handle.traits = sample.traits;
    slot_.sample.publish();
    now_.result_us.add(1e6 * (now - result.time));
    now_.answer_us.add(1e6 * (seconds(monotonic_now()) - sample.time));
  }
  const bool was_live = now_.sample.state == DeviceState::kLive;
  now_.losses += was_live && sample.state != DeviceState::kLive ? 1U : 0U;
  now_.sample = sample;
  now_.outcome = outcome;
  now_.coupling = side_.coupling;
  now_.hold = side_.hold;
  show_guard();
  views_.back() = now_;
  views_.publish();
  return outcome.sent;
}

void DeviceLink::show_guard() {
  const OutputGuard& guard = side_.guard;
  if (guard.state == GuardState::kFalling) {
    now_.stopped_by = guard.reason;
  } else if (guard.state == GuardState::kLive) {
    now_.stopped_by = GuardReason::kNone;
  }
  now_.guard = guard.state;
  now_.reason = guard.reason;
  now_.signs = guard.signs;
  now_.reversed_axes = side_.signs.reversed;
  const double largest = side_.limits.largest_force;
  const double largest_torque = side_.limits.largest_torque;
  now_.is_warm = allowed_now(guard.force_heat, largest) < largest ||
                 allowed_now(guard.torque_heat, largest_torque) < largest_torque;
}

const DeviceView& DeviceLink::view() {
  views_.refresh();
  return views_.front();
}

}  // namespace torsion::engine
