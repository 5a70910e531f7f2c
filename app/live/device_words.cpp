#include "app/live/device_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "device/device_text.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion::engine {
namespace {

std::string sensed_by(const DeviceSample& sample) {
  return sensed_text(sample.sensed) + (sample.buttons_turn ? ", two buttons turn" : "");
}

/// How a device holds a tool, and what set the stiffnesses of its coupling.
std::vector<std::string> hold_lines(const DeviceView& view) {
  const VirtualCoupling& coupling = view.coupling;
  const CouplingChoice choice = choose_coupling(view.sample.traits);
  if (view.hold == ToolHold::kDirect) {
    std::string text =
        fmt::format("held directly: the contact is felt, up to {:.3g} N and {:.3g} N m",
                    coupling.largest_force, coupling.largest_torque);
    if (choice.limit == StiffnessLimit::kPassivity) {
      text += fmt::format("; one stiffer than {:.3g} N/m may shake", choice.coupling.stiffness);
    }
    return {text};
  }
  std::vector<std::string> lines = {
      fmt::format("coupling {:.4g} N/m ({}), up to {:.3g} N", coupling.stiffness,
                  limit_text(choice.limit), coupling.largest_force),
      fmt::format("turning {:.4g} N m/rad ({}), up to {:.3g} N m", coupling.turn_stiffness,
                  limit_text(choice.turn_limit), coupling.largest_torque)};
  if (view.hold == ToolHold::kMass) {
    lines.emplace_back("the tool has its mass");
  }
  return lines;
}

/// The axes of a set of bits, for a person.
std::string axis_words(std::uint8_t axes) {
  std::vector<std::string> words;
  for (std::size_t axis = 0; axis < kSignAxes; ++axis) {
    if ((axes >> axis & 1U) != 0) {
      words.emplace_back(sign_axis_name(axis));
    }
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

const char* signs_word(SignVerdict signs) {
  switch (signs) {
    case SignVerdict::kRight:
      return "right";
    case SignVerdict::kReversed:
      return "reversed";
    case SignVerdict::kUnresolved:
      return "not seen";
    default:
      return "not looked at";
  }
}

/// Why a device has no force that is off for good, and what to do.
std::string off_words(const DeviceView& view) {
  if (view.reason == GuardReason::kReversed) {
    return fmt::format(
        "it goes the other way than it is pushed ({}): no force. Mend the signs of its motors or "
        "encoders (a gateway's client: its axes; a wheel: --wheel-reversed), then plug it in again",
        axis_words(view.reversed_axes));
  }
  return "it ran against the force, faster and faster: no force. Are its motors and encoders the "
         "right way round? Plug it in again and hold it firmly";
}

/// What ended the last force, and what to do; empty where nothing did.
std::string stop_words(GuardReason reason) {
  const GuardLimits limits;
  switch (reason) {
    case GuardReason::kLetGo:
      return "hold the button that enables the force";
    case GuardReason::kPhysics:
      return "the simulation was silent or had a fault";
    case GuardReason::kTooFast:
      return fmt::format("it moved faster than {} m/s or {} rad/s; move it more slowly",
                         limits.largest_speed, limits.largest_turn_speed);
    default:
      return "";
  }
}

/// Of a live device: what stands between it and its whole force; empty where nothing does.
std::string guard_words(const DeviceView& view) {
  const std::string stopped = stop_words(view.stopped_by);
  switch (view.guard) {
    case GuardState::kWaiting:
      if (view.reason != GuardReason::kFar && view.reason != GuardReason::kNone) {
        const std::string against = stop_words(view.reason);
        return against.empty() ? std::string() : "no force: " + against;
      }
      return fmt::format("bring it to the tool: {:.0f} mm to go{}{}", 1e3 * view.outcome.distance,
                         stopped.empty() ? "" : "; ", stopped);
    case GuardState::kChecking:
      return "a small force looks whether it goes where it is pushed; hold it loosely and still";
    case GuardState::kOff:
      return off_words(view);
    default:
      return view.is_warm ? "its motors are warm: less than its largest force" : "";
  }
}

}  // namespace

std::string describe(const DeviceView& view) {
  const DeviceSample& sample = view.sample;
  const std::string trouble = trouble_text(sample);
  if (sample.state == DeviceState::kAbsent) {
    return "no device is plugged in";
  }
  if (sample.state != DeviceState::kLive) {
    return "not ready: " + (trouble.empty() ? "it is being set up" : trouble);
  }
  std::string text =
      fmt::format("{:.0f} Hz; measures {}; displays {}; {}", sample.rate, sensed_by(sample),
                  actuated_text(sample.actuated), fmt::join(hold_lines(view), "; "));
  const std::string guard = guard_words(view);
  text += guard.empty() ? "" : "; " + guard;
  if (view.signs == SignVerdict::kUnresolved && sample.actuated != kNoAxes) {
    text += "; whether all its axes go where they are pushed could not be seen";
  }
  return trouble.empty() ? text : text + "; another one: " + trouble;
}

std::vector<std::string> device_lines(const DeviceView& view) {
  const DeviceSample& sample = view.sample;
  if (sample.state != DeviceState::kLive) {
    return {"device: " +
            std::string(sample.state == DeviceState::kAbsent ? "none is plugged in" : "not ready")};
  }
  std::vector<std::string> lines = {fmt::format("held by a device: {:.0f} Hz", sample.rate),
                                    "measures " + sensed_by(sample),
                                    "displays " + actuated_text(sample.actuated)};
  for (std::string& line : hold_lines(view)) {
    lines.push_back(std::move(line));
  }
  if (sample.garbage > 0) {
    lines.push_back(fmt::format("{} packets that were none", sample.garbage));
  }
  return lines;
}

std::string not_displayed(const DeviceView& view) {
  const DeviceSample& sample = view.sample;
  if (sample.state != DeviceState::kLive) {
    return "";
  }
  const bool force = (sample.actuated & kTranslationAxes) != 0;
  const bool torque = (sample.actuated & kRotationAxes) != 0;
  const bool turn_only = (sample.actuated & kTurnAxis) != 0;
  if (!force && !torque && !turn_only) {
    return "Force and torque are only drawn: this device displays neither.";
  }
  if (!force) {
    return "The force is only drawn: this device does not display it.";
  }
  if (!torque) {
    return turn_only ? "Of the torque only the part about the turn axis is displayed."
                     : "The torque is only drawn: this device does not display it.";
  }
  return "";
}

DeviceBanner device_banner(const DeviceView& view, bool steps_go_on) {
  const DeviceSample& sample = view.sample;
  if (sample.state == DeviceState::kAbsent) {
    return view.losses > 0 ? DeviceBanner{"The device is gone: no force, the tool stays. Plug it "
                                          "in again to go on.",
                                          true}
                           : DeviceBanner{"No device is plugged in that could hold the tool."};
  }
  if (sample.trouble != DeviceTrouble::kNone) {
    return {"The device: " + trouble_text(sample) + ".", true};
  }
  if (sample.state != DeviceState::kLive) {
    return {view.losses > 0 ? "The device does not answer: no force. It is set up anew."
                            : "The device is being set up.",
            view.losses > 0};
  }
  if (!steps_go_on) {
    return {"No force in a pause and in slow motion."};
  }
  if (view.guard == GuardState::kWaiting && view.reason == GuardReason::kFar) {
    const std::string stopped = stop_words(view.stopped_by);
    return {fmt::format("Bring the device to the tool: {:.0f} mm to go. No force before.{}{}",
                        1e3 * view.outcome.distance, stopped.empty() ? "" : " Why: ", stopped)};
  }
  const std::string guard = guard_words(view);
  return guard.empty() ? DeviceBanner{}
                       : DeviceBanner{"The device: " + guard + ".", view.guard == GuardState::kOff};
}

std::string device_summary(const DeviceView& view) {
  std::string text = fmt::format("device   {}\n", describe(view));
  if (view.answer_us.count() > 0) {
    text += fmt::format(
        "         {} samples; lost {} times; {} packets that were none; from a sample to the force "
        "that is sent median "
        "{:.0f} us, 99 % {:.0f} us; the physics' result in it {:.0f} us, {:.0f} us old\n",
        view.sample.number, view.losses, view.sample.garbage, view.answer_us.quantile(0.5),
        view.answer_us.quantile(0.99), view.result_us.quantile(0.5), view.result_us.quantile(0.99));
  }
  return text;
}

nlohmann::ordered_json device_json(const DeviceView& view) {
  return {{"state", describe(view)},
          {"signs", signs_word(view.signs)},
          {"rate_Hz", view.sample.rate},
          {"samples", view.sample.number},
          {"losses", view.losses},
          {"garbage", view.sample.garbage},
          {"sample_to_force_us",
           {{"median", view.answer_us.quantile(0.5)}, {"p99", view.answer_us.quantile(0.99)}}},
          {"result_age_us",
           {{"median", view.result_us.quantile(0.5)}, {"p99", view.result_us.quantile(0.99)}}}};
}

}  // namespace torsion::engine
