#include "app/live/device_link.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/live/measured_traits.hpp"
#include "app/live/periodic_clock.hpp"
#include "app/live/realtime_mode.hpp"

namespace torsion::engine {
namespace {

constexpr std::string_view kUsb = "usb";
constexpr std::string_view kGateway = "gateway";

double seconds(Nanoseconds time) {
  return 1e-9 * static_cast<double>(time);
}

}  // namespace

Result<std::vector<std::uint8_t>> load_firmware(const std::filesystem::path& chosen) {
  const std::filesystem::path path = chosen.empty() ? usual_falcon_firmware() : chosen;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    if (chosen.empty()) {
      return std::vector<std::uint8_t>{};
    }
    return Error{path.string() + ": cannot be read; --falcon-firmware wants the maker's file"};
  }
  std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)),
                                  std::istreambuf_iterator<char>());
  if (bytes.size() < kSmallestFirmware || bytes.size() > kLargestFirmware) {
    return Error{fmt::format("{}: {} bytes are no Falcon firmware, which has {} to {}",
                             path.string(), bytes.size(), kSmallestFirmware, kLargestFirmware)};
  }
  return bytes;
}

LoopOptions loop_of(const DeviceChoice& choice, std::uint32_t kinds,
                    std::span<const std::uint8_t> firmware) {
  LoopOptions options;
  options.kinds = kinds;
  options.drivers.falcon_firmware = firmware;
  options.drivers.largest_knob_torque = choice.largest_knob_torque;
  options.drivers.wheel_torque = choice.wheel_torque;
  options.drivers.wheel_range = choice.wheel_range / 180.0 * std::numbers::pi;
  options.drivers.wheel_reversed = choice.wheel_reversed;
  options.turn_buttons = choice.turn_buttons;
  return options;
}

namespace {

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

Result<std::uint32_t> kinds_of(const std::string& what) {
  if (what == kUsb) {
    return kUsualDevices;
  }
  const Error wrong{
      fmt::format("--device {}: expected usb, or usb: and some of spacemouse, falcon, "
                  "woodenhaptics, odrive, moteus, wheel with + between, or gateway",
                  what)};
  if (what.rfind("usb:", 0) != 0) {
    return wrong;
  }
  std::uint32_t kinds = 0;
  std::string_view rest = std::string_view(what).substr(4);
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find('+'));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    const std::uint32_t before = kinds;
    for (std::uint32_t kind = 0; kind < kDeviceKinds; ++kind) {
      kinds |= word == word_of(static_cast<DeviceKind>(kind)) ? 1U << kind : 0U;
    }
    if (kinds == before) {
      return wrong;
    }
  }
  return kinds != 0 ? Result<std::uint32_t>(kinds) : wrong;
}

std::filesystem::path user_data_folder() {
  const char* const data = std::getenv("XDG_DATA_HOME");  // NOLINT(concurrency-mt-unsafe): at start
  const char* const home = std::getenv("HOME");           // NOLINT(concurrency-mt-unsafe): at start
  const std::filesystem::path folder =
      data != nullptr && *data != 0
          ? std::filesystem::path(data)
          : std::filesystem::path(home != nullptr ? home : "/") / ".local/share";
  return folder / "torsion";
}

std::filesystem::path usual_falcon_firmware() {
  return user_data_folder() / "falcon_firmware.bin";
}

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

Result<std::unique_ptr<DeviceLink>> DeviceLink::open(const DeviceChoice& choice, const Pose& tool) {
  if (choice.what.starts_with(kGateway)) {
    Result<GatewayOptions> options = gateway_of(choice.what);
    if (!options) {
      return options.error();
    }
    std::unique_ptr<DeviceLink> link = held_as(choice, tool);
    options.value().on_start = [] {
      become_realtime();
    };
    auto gateway = Gateway::start(std::move(options).value(), {{link.get(), on_sample}, describe});
    if (!gateway) {
      return gateway.error();
    }
    link->gateway_ = std::move(gateway).value();
    return link;
  }
  const Result<std::uint32_t> kinds = kinds_of(choice.what);
  if (!kinds) {
    return kinds.error();
  }
  Result<std::vector<std::uint8_t>> firmware = load_firmware(choice.falcon_firmware);
  if (!firmware) {
    return firmware.error();
  }
  auto measured = load_measured_traits();
  if (!measured) {
    return measured.error();
  }
  std::unique_ptr<DeviceLink> link = held_as(choice, tool);
  link->firmware_ = std::move(firmware).value();
  UsbBusOptions options;
  options.loop = loop_of(choice, kinds.value(), link->firmware_);
  options.loop.measured = measured.value();
  options.loop.turn_axis = tool.rotation * glm::dvec3(0.0, 1.0, 0.0);
  options.on_start = [] {
    become_realtime();
  };
  auto bus = UsbBus::start(options, {link.get(), on_sample});
  if (!bus) {
    return bus.error();
  }
  link->bus_ = std::move(bus).value();
  return link;
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
  return outcome.wrench;
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
