#pragma once

#include <optional>

#include "device/usb/usb_io.hpp"

struct libusb_device;

namespace torsion::engine {

/// What a device says of itself, from what the system has read of it already: nothing is opened.
/// @return nothing where it has gone
std::optional<UsbIdentity> read_identity(libusb_device* device);

}  // namespace torsion::engine
