#include "render/device_choice.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace torsion::engine {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return lower;
}

std::string described(const DeviceFacts& device) {
  std::string text = "\"" + device.name + "\"";
  for (std::size_t i = 0; i < device.missing.size(); ++i) {
    text += (i == 0 ? " (lacks " : ", ") + device.missing[i];
  }
  return device.missing.empty() ? text : text + ")";
}

std::string described(std::span<const DeviceFacts> devices) {
  std::string text;
  for (const DeviceFacts& device : devices) {
    text += (text.empty() ? "" : ", ") + described(device);
  }
  return text;
}

}  // namespace

Result<std::size_t> choose_device(std::span<const DeviceFacts> devices, std::string_view wanted) {
  if (devices.empty()) {
    return Error{
        "Vulkan finds no device to draw with. Install a driver; mesa-vulkan-drivers has one that "
        "needs no graphics "
        "card."};
  }
  const std::string part = lower_case(wanted);
  std::optional<std::size_t> best;
  bool named = false;
  for (std::size_t row = 0; row < devices.size(); ++row) {
    if (lower_case(devices[row].name).find(part) == std::string::npos) {
      continue;
    }
    named = true;
    const bool better = !best || devices[row].kind < devices[*best].kind;
    if (devices[row].missing.empty() && better) {
      best = row;
    }
  }
  if (best) {
    return *best;
  }
  if (!named) {
    return Error{"No Vulkan device has \"" + std::string(wanted) +
                 "\" in its name (environment variable TORSION_GPU). There are: " +
                 described(devices) + "."};
  }
  return Error{
      "No Vulkan device can do all that drawing needs. There are: " + described(devices) +
      ". mesa-vulkan-drivers 22.3 or newer has a driver that can and needs no graphics card."};
}

}  // namespace torsion::engine
