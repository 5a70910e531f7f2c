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
  if (!view.outcome.holds) {
    text += fmt::format("; bring it to the tool: {:.0f} mm to go", 1e3 * view.outcome.distance);
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
  if (!view.outcome.holds) {
    return {fmt::format("Bring the device to the tool: {:.0f} mm to go. No force before.",
                        1e3 * view.outcome.distance)};
  }
  return {};
}

std::string device_summary(const DeviceView& view) {
  std::string text = fmt::format("device   {}\n", describe(view));
  if (view.answer_us.count() > 0) {
    text += fmt::format(
        "         {} samples; lost {} times; from a sample to the force that is sent median "
        "{:.0f} us, 99 % {:.0f} us; the physics' result in it {:.0f} us, {:.0f} us old\n",
        view.sample.number, view.losses, view.answer_us.quantile(0.5),
        view.answer_us.quantile(0.99), view.result_us.quantile(0.5), view.result_us.quantile(0.99));
  }
  return text;
}

nlohmann::ordered_json device_json(const DeviceView& view) {
  return {{"state", describe(view)},
          {"rate_Hz", view.sample.rate},
          {"samples", view.sample.number},
          {"losses", view.losses},
          {"sample_to_force_us",
           {{"median", view.answer_us.quantile(0.5)}, {"p99", view.answer_us.quantile(0.99)}}},
          {"result_age_us",
           {{"median", view.result_us.quantile(0.5)}, {"p99", view.result_us.quantile(0.99)}}}};
}

}  // namespace torsion::engine
