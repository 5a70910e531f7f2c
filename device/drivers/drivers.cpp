#include "device/drivers/drivers.hpp"

#include <algorithm>

namespace torsion::engine {
namespace {

struct Ids {
  std::uint16_t vendor;
  std::uint16_t product;

  bool operator==(const Ids&) const = default;
};

constexpr Ids kFalconIds{0x0403, 0xCB48};
constexpr Ids kOdriveIds{0x1209, 0x0D32};
constexpr Ids kWoodenMbed{0x1234, 0x0006};
constexpr Ids kFdcanusb{0x0483, 0x5740};
constexpr Ids kMoteusUsb{0x1209, 0x2323};
constexpr Ids kOpenFfbBoard{0x1209, 0xFFB0};

bool has_hid(const UsbIdentity& identity) {
  return std::ranges::any_of(identity.interfaces, [](const UsbInterface& interface) {
    return interface.device_class == kHidClass && interface.protocol == 0;
  });
}

}  // namespace

std::string_view name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::kSpaceMouse:
      return "SpaceMouse";
    case DeviceKind::kFalcon:
      return "Novint Falcon";
    case DeviceKind::kWoodenHaptics:
      return "WoodenHaptics";
    case DeviceKind::kMoteus:
      return "moteus knob";
    case DeviceKind::kWheel:
      return "force-feedback wheel";
    default:
      return "ODrive knob";
  }
}

std::string_view word_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::kSpaceMouse:
      return "spacemouse";
    case DeviceKind::kFalcon:
      return "falcon";
    case DeviceKind::kWoodenHaptics:
      return "woodenhaptics";
    case DeviceKind::kMoteus:
      return "moteus";
    case DeviceKind::kWheel:
      return "wheel";
    default:
      return "odrive";
  }
}

std::optional<DeviceKind> kind_of(const UsbIdentity& identity) {
  const Ids ids{identity.vendor, identity.product};
  if (ids == kFalconIds) {
    return DeviceKind::kFalcon;
  }
  if (ids == kOdriveIds) {
    return DeviceKind::kOdrive;
  }
  if (ids == kWoodenMbed) {
    return DeviceKind::kWoodenHaptics;
  }
  if (ids == kFdcanusb || ids == kMoteusUsb) {
    return DeviceKind::kMoteus;
  }
  if (ids == kOpenFfbBoard ||
      std::ranges::any_of(identity.interfaces, &UsbInterface::plays_effects)) {
    return DeviceKind::kWheel;
  }
  if (is_not_a_space_mouse(ids.vendor, ids.product)) {
    return std::nullopt;
  }
  // A newer one than the table: its report descriptor will say whether it has six axes.
  const bool may_be = ids.vendor == k3Dconnexion && has_hid(identity);
  return may_be || is_space_mouse(ids.vendor, ids.product) ? std::optional(DeviceKind::kSpaceMouse)
                                                           : std::nullopt;
}

Driver driver_for(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::kSpaceMouse:
      return SpaceMouseDriver{};
    case DeviceKind::kFalcon:
      return FalconDriver{};
    case DeviceKind::kWoodenHaptics:
      return WoodenDriver{};
    case DeviceKind::kMoteus:
      return MoteusDriver{};
    case DeviceKind::kWheel:
      return WheelDriver{};
    default:
      return OdriveDriver{};
  }
}

}  // namespace torsion::engine
