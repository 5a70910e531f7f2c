#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "device/drivers/falcon_driver.hpp"
#include "device/drivers/moteus_driver.hpp"
#include "device/drivers/odrive_driver.hpp"
#include "device/drivers/space_mouse_driver.hpp"
#include "device/drivers/wheel_driver.hpp"
#include "device/drivers/wooden_driver.hpp"

namespace torsion::engine {

enum class DeviceKind : std::uint8_t {
  kSpaceMouse,
  kFalcon,
  kWoodenHaptics,
  kOdrive,
  kMoteus,
  kWheel
};

inline constexpr std::uint32_t kDeviceKinds = 6;

/// Bits 1 << DeviceKind: those whose ids are their own. A WoodenHaptics has that of every mbed
/// board that nobody gave another, a moteus' adapter that of every serial port on an STM32, and a
/// wheel is any device that plays effects, a joystick too, so they have to be asked for by name.
inline constexpr std::uint32_t kUsualDevices =
    ~(1U << static_cast<std::uint32_t>(DeviceKind::kWoodenHaptics) |
      1U << static_cast<std::uint32_t>(DeviceKind::kMoteus) |
      1U << static_cast<std::uint32_t>(DeviceKind::kWheel));

/// For a person, and as a word in options.
std::string_view name_of(DeviceKind kind);
std::string_view word_of(DeviceKind kind);

/// What a device is by its ids and its interfaces.
/// @return nothing for what Torsion does not use
std::optional<DeviceKind> kind_of(const UsbIdentity& identity);

using Driver = std::variant<SpaceMouseDriver, FalconDriver, WoodenDriver, OdriveDriver,
                            MoteusDriver, WheelDriver>;

Driver driver_for(DeviceKind kind);

}  // namespace torsion::engine
