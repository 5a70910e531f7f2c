#include "app/live/device_choice.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/file_bytes.hpp"

namespace torsion::engine {
namespace {

constexpr std::string_view kUsb = "usb";

std::optional<DeviceKind> kind_named(std::string_view word) {
  for (std::uint32_t kind = 0; kind < kDeviceKinds; ++kind) {
    if (word == word_of(static_cast<DeviceKind>(kind))) {
      return static_cast<DeviceKind>(kind);
    }
  }
  return std::nullopt;
}

bool is_knob(DeviceKind kind) {
  return kind == DeviceKind::kOdrive || kind == DeviceKind::kMoteus || kind == DeviceKind::kWheel;
}

}  // namespace

Result<std::vector<std::uint8_t>> load_firmware(const std::filesystem::path& chosen) {
  const std::filesystem::path path = chosen.empty() ? usual_falcon_firmware() : chosen;
  Result<std::vector<unsigned char>> read = read_file_bytes(path);
  if (!read) {
    if (chosen.empty()) {
      return std::vector<std::uint8_t>{};
    }
    return Error{read.error().text + "; --falcon-firmware wants the maker's file"};
  }
  std::vector<std::uint8_t> bytes = std::move(read).value();
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

Result<GatewayChoice> gateway_choice(const std::string& what) {
  GatewayChoice choice;
  std::string_view rest = what;
  for (std::size_t plus = rest.rfind('+'); plus != std::string_view::npos; plus = rest.rfind('+')) {
    const std::optional<DeviceKind> kind = kind_named(rest.substr(plus + 1));
    if (!kind && rest.find('/') < plus) {
      break;  // a path of a socket may have that in its name
    }
    if (!kind || !is_knob(*kind)) {
      return Error{fmt::format(
          "--device {}: expected a knob after gateway+: odrive, moteus or wheel", what)};
    }
    choice.knobs |= 1U << static_cast<std::uint32_t>(*kind);
    rest = rest.substr(0, plus);
  }
  choice.gateway = rest;
  return choice;
}

Result<std::vector<std::uint8_t>> load_secret(const std::filesystem::path& path) {
  const std::string make =
      fmt::format("make one by: (umask 077; head -c 32 /dev/urandom | base64 > {})", path.string());
  const Result<std::vector<unsigned char>> read = read_file_bytes(path);
  if (!read) {
    return Error{fmt::format("--gateway-secret {}; {}", read.error().text, make)};
  }
  const std::string text(read.value().begin(), read.value().end());
  std::error_code none;
  const auto others = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
  if ((std::filesystem::status(path, none).permissions() & others) !=
      std::filesystem::perms::none) {
    return Error{fmt::format(
        "--gateway-secret {}: others than its owner can read or write it; mend it by: chmod 600 {}",
        path.string(), path.string())};
  }
  constexpr std::string_view kWhite = " \t\r\n";
  const std::size_t first = std::min(text.find_first_not_of(kWhite), text.size());
  const std::size_t last = text.find_last_not_of(kWhite) + 1;  // 0 of nothing
  const std::string_view secret =
      std::string_view(text).substr(first, last - std::min(first, last));
  if (secret.size() < kShortestSecret || secret.size() > kLongestSecret) {
    return Error{fmt::format("--gateway-secret {}: {} bytes, expected {} to {}; {}", path.string(),
                             secret.size(), kShortestSecret, kLongestSecret, make)};
  }
  return std::vector<std::uint8_t>(secret.begin(), secret.end());
}

Result<GatewayOptions> gateway_options(const DeviceChoice& choice, const std::string& gateway) {
  Result<GatewayOptions> options = gateway_of(gateway);
  if (!options) {
    return options;
  }
  if (!choice.gateway_address.empty()) {
    if (!options.value().socket.empty()) {
      return Error{
          fmt::format("--gateway-address {}: a Unix socket has no address; give "
                      "--device gateway:PORT",
                      choice.gateway_address)};
    }
    options.value().address = choice.gateway_address;
  }
  if (!choice.gateway_secret.empty()) {
    Result<std::vector<std::uint8_t>> secret = load_secret(choice.gateway_secret);
    if (!secret) {
      return secret.error();
    }
    options.value().secret = std::move(secret).value();
  }
  return options;
}

Result<std::uint32_t> kinds_of(const std::string& what) {
  if (what == kUsb) {
    return kUsualDevices;
  }
  const Error wrong{fmt::format(
      "--device {}: expected usb, or usb: and some of spacemouse, falcon, "
      "woodenhaptics, odrive, moteus, wheel with + between, or gateway, or gateway+ and a knob",
      what)};
  if (what.rfind("usb:", 0) != 0 || what.back() == '+') {
    return wrong;
  }
  std::uint32_t kinds = 0;
  std::string_view rest = std::string_view(what).substr(4);
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find('+'));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    const std::optional<DeviceKind> kind = kind_named(word);
    if (!kind) {
      return wrong;
    }
    kinds |= 1U << static_cast<std::uint32_t>(*kind);
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

}  // namespace torsion::engine
