#pragma once

#include <string>
#include <string_view>

#include "device/drivers/drivers.hpp"
#include "ecs/device_sample.hpp"

namespace torsion::engine {

/// What is wrong and what to do about it, one sentence; empty where nothing is.
std::string trouble_text(const DeviceSample& sample);

/// "force and torque", "force; torque is not displayed", ...
std::string actuated_text(std::uint8_t actuated);
std::string sensed_text(std::uint8_t sensed);

/// The line of udev that lets whoever sits at the machine use a device, and how to install the file
/// that has it.
std::string udev_rule(const UsbIdentity& identity);
std::string_view udev_advice();

}  // namespace torsion::engine
