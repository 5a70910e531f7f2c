#include "device/device_text.hpp"

#include <fmt/format.h>

namespace torsion::engine {
namespace {

/// All that happened to its motor is that this machine was too busy to feed it.
bool was_only_unfed(const DeviceSample& sample) {
  switch (sample.motor) {
    case MotorKind::kMoteus:
      return sample.motor_errors == kMoteusUnfed;
    case MotorKind::kWheel:
      return false;
    default:
      return only_unfed(sample.motor, sample.motor_errors);
  }
}

std::string motor_text(const DeviceSample& sample) {
  switch (sample.motor) {
    case MotorKind::kMoteus:
      return moteus_fault_text(sample.motor_errors);
    case MotorKind::kWheel:
      return std::string(wheel_error_text(sample.motor_errors));
    default:
      return odrive_error_text(sample.motor, sample.motor_errors);
  }
}

}  // namespace

std::string trouble_text(const DeviceSample& sample) {
  switch (sample.trouble) {
    case DeviceTrouble::kNone:
      return "";
    case DeviceTrouble::kNoAccess:
      return "this user may not open it; `torsion devices` has the udev rule that lets them";
    case DeviceTrouble::kHeldElsewhere:
      return "another program holds it; end that program (`torsion devices` names it)";
    case DeviceTrouble::kNoFirmware:
      return "it has no firmware; give the file of its maker with --falcon-firmware FILE";
    case DeviceTrouble::kBadFirmware:
      return "it did not take the firmware file; is it the right one? Unplug it and plug it in";
    case DeviceTrouble::kWrongFirmware:
      return "its firmware is another version than Torsion speaks to (ODrive: 0.5.4 to 0.6; "
             "moteus: register map 5); "
             "update it with its maker's tool, then unplug it and plug it in";
    case DeviceTrouble::kNotHomed:
      return "it does not know its zero yet; move it through its whole range (a WoodenHaptics: "
             "hold its first two bodies upright and forward, the third level, and press and let go "
             "of its calibration button)";
    case DeviceTrouble::kNotMoved:
      return "it has not said yet where it is; turn it a little";
    case DeviceTrouble::kSilent:
      return "it does not answer; is its power on?";
    case DeviceTrouble::kNotUnderstood:
      return "it does not speak as such a device should";
    case DeviceTrouble::kNoClient:
      return "no client speaks to the gateway; start one (docs/gateway.md)";
    case DeviceTrouble::kWrongSecret:
      return "a client speaks that has another secret than the gateway, or one of the two has "
             "none; "
             "give both the same file (--gateway-secret FILE)";
    case DeviceTrouble::kMotorError:
      return fmt::format(
          "its motor has no force ({}). {}", motor_text(sample),
          was_only_unfed(sample) ? "It is set up anew" : "Then unplug it and plug it in");
  }
  return "";
}

std::string sensed_text(std::uint8_t sensed) {
  const bool moves = (sensed & kTranslationAxes) != 0;
  const char* const turns = (sensed & kRotationAxes) != 0 ? "turning"
                            : (sensed & kTurnAxis) != 0   ? "turn"
                                                          : "";
  return fmt::format("{}{}{}", moves ? "translation" : "", moves && *turns != 0 ? " and " : "",
                     turns);
}

std::string actuated_text(std::uint8_t actuated) {
  const bool force = (actuated & kTranslationAxes) != 0;
  const char* const torque = (actuated & kRotationAxes) != 0 ? "torque"
                             : (actuated & kTurnAxis) != 0   ? "torque about the turn axis"
                                                             : "";
  if (!force && *torque == 0) {
    return "nothing: force and torque are not displayed";
  }
  return fmt::format("{}{}{}{}", force ? "force" : "", force && *torque != 0 ? " and " : "", torque,
                     *torque == 0 ? "; torque is not displayed" : "");
}

std::string udev_rule(const UsbIdentity& identity) {
  return fmt::format(
      R"(SUBSYSTEM=="usb", ATTR{{idVendor}}=="{:04x}", ATTR{{idProduct}}=="{:04x}", TAG+="uaccess")",
      identity.vendor, identity.product);
}

std::string_view udev_advice() {
  return "sudo install -m 644 device/60-torsion.rules /etc/udev/rules.d/ && sudo udevadm control "
         "--reload && sudo udevadm trigger --subsystem-match=usb --action=add";
}

}  // namespace torsion::engine
