#pragma once

#include <string>
#include <vector>

#include "device/drivers/drivers.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// A device that is plugged in, as `torsion devices` shows it.
struct ListedDevice {
  DeviceKind kind = DeviceKind::kSpaceMouse;
  UsbIdentity identity;
  DeviceTrouble access = DeviceTrouble::kNone;  // kSilent: it cannot be opened for another reason
  std::vector<std::string> kernel_drivers;      // that hold its interfaces
  std::string holder;                           // the program that has it, as far as can be seen
};

/// The devices on the bus that Torsion knows. Opens each for a moment, takes none from anybody.
Result<std::vector<ListedDevice>> list_usb_devices();

}  // namespace torsion::engine
