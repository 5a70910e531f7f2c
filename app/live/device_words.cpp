#include "app/live/device_words.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/device_text.hpp"

namespace torsion {
namespace {

std::string sensed_by(const DeviceSample& sample) {
  return sensed_text(sample.sensed) + (sample.buttons_turn ? ", two buttons turn" : "");
}

/// Of the coupling in translation, and in turning.
std::string gain_text(const VirtualCoupling& coupling) {
  return fmt::format("{:.4g} N/m, up to {:.3g} N", coupling.stiffness, coupling.largest_force);
}
std::string turn_gain_text(const VirtualCoupling& coupling) {
  return fmt::format("{:.4g} N m/rad, up to {:.3g} N m", coupling.turn_stiffness,
                     coupling.largest_torque);
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
  std::string text = fmt::format("{:.0f} Hz; measures {}; displays {}; coupling {}; turning {}",
                                 sample.rate, sensed_by(sample), actuated_text(sample.actuated),
                                 gain_text(view.coupling), turn_gain_text(view.coupling));
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
  return {fmt::format("held by a device: {:.0f} Hz", sample.rate), "measures " + sensed_by(sample),
          "displays " + actuated_text(sample.actuated), "coupling " + gain_text(view.coupling),
          "turning " + turn_gain_text(view.coupling)};
}

std::string not_displayed(const DeviceView& view) {
  const DeviceSample& sample = view.sample;
  if (sample.state != DeviceState::kLive) {
    return "";
  }
  const bool force = (sample.actuated & kTranslationAxes) != 0;
  const bool torque = (sample.actuated & kRotationAxes) != 0;
  const bool twist = (sample.actuated & kTwistAxis) != 0;
  if (!force && !torque && !twist) {
    return "Force and torque are only drawn: this device displays neither.";
  }
  if (!force) {
    return "The force is only drawn: this device does not display it.";
  }
  if (!torque) {
    return twist ? "Of the torque only the part about the twist axis is displayed."
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

}  // namespace torsion
