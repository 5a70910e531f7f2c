#include <algorithm>
#include <iterator>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/device_options.hpp"
#include "app/measure_device.hpp"
#include "device/device_text.hpp"
#include "device/usb/usb_list.hpp"

namespace torsion::engine {
namespace {

struct DevicesOptions {
  DeviceChoice choice;
  bool json = false;
  bool measures = false;
  bool agreed = false;
};

/// What stands between a device and its use, one line each.
std::vector<std::string> problems_of(const ListedDevice& device, const DevicesOptions& options) {
  std::vector<std::string> problems;
  if (device.access == DeviceTrouble::kNoAccess) {
    problems.push_back(
        fmt::format("this user may not open it. The udev rule\n    {}\n  is in "
                    "device/60-torsion.rules; to install it:\n    {}",
                    udev_rule(device.identity), udev_advice()));
  }
  if (device.access == DeviceTrouble::kHeldElsewhere) {
    problems.emplace_back("another program holds it: " + device.holder);
  }
  if (device.access == DeviceTrouble::kSilent) {
    problems.emplace_back("it cannot be opened; unplug it and plug it in again");
  }
  if (device.kind == DeviceKind::kFalcon) {
    const auto path = options.choice.falcon_firmware.empty() ? usual_falcon_firmware()
                                                             : options.choice.falcon_firmware;
    if (!std::filesystem::exists(path)) {
      problems.push_back(
          fmt::format("after it was switched on it needs its maker's firmware, which may not be "
                      "shipped: {} is not there; put it there or say --falcon-firmware FILE",
                      path.string()));
    }
  }
  return problems;
}

/// What a user should know, though nothing has to be done about it.
std::vector<std::string> notes_of(const ListedDevice& device) {
  std::vector<std::string> notes;
  for (const std::string& driver : device.kernel_drivers) {
    notes.push_back(fmt::format("the kernel's {} has it, and gets it back afterwards", driver));
  }
  switch (device.kind) {
    case DeviceKind::kSpaceMouse:
      notes.emplace_back("measures six axes; force and torque are not displayed");
      break;
    case DeviceKind::kFalcon:
      notes.emplace_back(
          "measures and displays translation; torque is not displayed, but by two or three "
          "together, or with an ODrive knob");
      break;
    case DeviceKind::kWoodenHaptics:
      notes.emplace_back("measures and displays translation; torque is not displayed");
      notes.emplace_back(
          "has the id of every mbed board that nobody gave another: --device usb leaves it alone, "
          "--device usb:woodenhaptics takes it");
      break;
    case DeviceKind::kMoteus:
      notes.emplace_back("measures and displays torque about the turn axis");
      notes.emplace_back(
          "has the id of many serial ports: --device usb:moteus takes it, --device usb does not");
      break;
    case DeviceKind::kWheel:
      notes.emplace_back(
          "measures turn; displays torque about the turn axis where --wheel-torque says how much "
          "its full scale is");
      notes.emplace_back(
          "any device that plays effects counts as a wheel, a joystick too: --device usb:wheel "
          "takes it, --device usb does not");
      break;
    case DeviceKind::kOdrive:
      notes.emplace_back("measures and displays torque about the turn axis");
      break;
  }
  return notes;
}

void print(const ListedDevice& device, const DevicesOptions& options) {
  const std::vector<std::string> problems = problems_of(device, options);
  fmt::print("{} ({:04x}:{:04x}, bus {} address {}): {}\n", name_of(device.kind),
             device.identity.vendor, device.identity.product, device.identity.bus,
             device.identity.address,
             device.access == DeviceTrouble::kNone ? "usable" : "NOT usable");
  for (const std::string& problem : problems) {
    fmt::print("  missing: {}\n", problem);
  }
  for (const std::string& note : notes_of(device)) {
    fmt::print("  {}\n", note);
  }
}

nlohmann::ordered_json to_json(const ListedDevice& device, const DevicesOptions& options) {
  return {{"kind", word_of(device.kind)},
          {"vendor", fmt::format("{:04x}", device.identity.vendor)},
          {"product", fmt::format("{:04x}", device.identity.product)},
          {"bus", device.identity.bus},
          {"address", device.identity.address},
          {"usable", device.access == DeviceTrouble::kNone},
          {"kernel_drivers", device.kernel_drivers},
          {"holder", device.holder},
          {"missing", problems_of(device, options)},
          {"notes", notes_of(device)}};
}

int devices(const DevicesOptions& options) {
  const Result<std::vector<ListedDevice>> listed = list_usb_devices();
  if (!listed) {
    return fail(listed.error().text);
  }
  if (options.json) {
    auto list = nlohmann::ordered_json::array();
    for (const ListedDevice& device : listed.value()) {
      list.push_back(to_json(device, options));
    }
    fmt::print("{}\n", nlohmann::ordered_json{{"devices", list}}.dump(2));
    return kDone;
  }
  if (listed.value().empty()) {
    fmt::print(
        "no device is plugged in that Torsion knows: SpaceMouse, Novint Falcon, WoodenHaptics, "
        "ODrive, moteus, force-feedback wheel\na mouse does, too: torsion view SCENE\n");
  }
  for (const ListedDevice& device : listed.value()) {
    print(device, options);
  }
  return kDone;
}

/// What its drivers have to know of a device.
void add_drive_options(CLI::App& subcommand, DeviceChoice& choice) {
  subcommand.add_option("--falcon-firmware", choice.falcon_firmware,
                        "The maker's file, where the usual place has none");
  subcommand
      .add_option("--knob-torque", choice.largest_knob_torque,
                  "Largest, N m, of an ODrive, a moteus or a wheel")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str();
  subcommand
      .add_option("--wheel-torque", choice.wheel_torque,
                  "N m that a force-feedback wheel has at its full scale, as it is set up; without "
                  "this it displays none")
      ->check(CLI::Range(0.1, 50.0));
  subcommand
      .add_option("--wheel-range", choice.wheel_range,
                  "Degrees that it turns from lock to lock, as it is set up")
      ->check(CLI::Range(90.0, 3600.0))
      ->capture_default_str();
  subcommand.add_flag("--wheel-reversed", choice.wheel_reversed,
                      "Its torque goes the other way than those of most wheels");
}

}  // namespace

void add_device_options(CLI::App& subcommand, DeviceChoice& choice) {
  subcommand
      .add_option_function<std::string>(
          "--hold",
          [&choice](const std::string& name) {
            const auto* const found = std::ranges::find(kToolHoldNames, name);
            choice.hold = static_cast<ToolHold>(std::distance(kToolHoldNames.begin(), found));
          },
          "How the tool is held: massless (where coupling and contact balance), with its mass, or "
          "directly (it is where the hand is; the hand feels the contact) [massless]")
      ->check(
          CLI::IsMember(std::vector<std::string>(kToolHoldNames.begin(), kToolHoldNames.end())));
  add_drive_options(subcommand, choice);
  CLI::Option* const device = subcommand.get_option("--device");
  subcommand
      .add_option("--gateway-address", choice.gateway_address,
                  "An address of this machine where clients on other machines reach the gateway "
                  "(0.0.0.0: all it has); wants --gateway-secret")
      ->needs(device);
  subcommand
      .add_option("--gateway-secret", choice.gateway_secret,
                  "A file whose text the gateway's clients must have, too")
      ->needs(device);
  subcommand
      .add_option_function<std::pair<std::uint32_t, std::uint32_t>>(
          "--turn-buttons",
          [&choice](const std::pair<std::uint32_t, std::uint32_t>& numbers) {
            choice.turn_buttons.left = 1U << (numbers.first - 1U);
            choice.turn_buttons.right = 1U << (numbers.second - 1U);
          },
          "Two buttons (1 to 32) that turn the tool counter-clockwise and clockwise where a device "
          "senses no turn [1 4]")
      ->check(CLI::Range(1, 32));
  subcommand
      .add_option_function<std::uint32_t>(
          "--enable-button",
          [&choice](std::uint32_t number) { choice.safety.held_buttons = 1U << (number - 1U); },
          "A button (1 to 32) that has to be held for any force")
      ->check(CLI::Range(1, 32));
  subcommand
      .add_option("--continuous-force", choice.safety.continuous_force,
                  "What its motors bear for ever, N, where the device's own is not right")
      ->check(CLI::PositiveNumber);
  subcommand.add_option("--continuous-torque", choice.safety.continuous_torque, "Likewise, N m")
      ->check(CLI::PositiveNumber);
  subcommand.add_flag_callback(
      "--no-sign-check", [&choice] { choice.safety.checks_signs = false; },
      "Do not see with a small force first whether it goes where it is pushed");
}

void add_devices(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand(
      "devices", "List what is plugged in and usable to hold a tool, and what is missing");
  auto options = std::make_shared<DevicesOptions>();
  subcommand->add_flag("--json", options->json, "Print as JSON");
  CLI::Option* measure = subcommand->add_flag("--measure", options->measures,
                                              "Find mass, damping, friction and delay of one, for "
                                              "sessions to count on; it moves by itself");
  subcommand->add_option("--device", options->choice.what, "Which one to measure: usb:falcon")
      ->needs(measure);
  measure->needs("--device");
  subcommand->add_flag("--yes", options->agreed, "Do not ask before it moves")->needs(measure);
  add_drive_options(*subcommand, options->choice);
  subcommand->callback([options, &command] {
    command = [options] {
      return options->measures ? measure_device(options->choice, options->agreed)
                               : devices(*options);
    };
  });
}

}  // namespace torsion::engine
