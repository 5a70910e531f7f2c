#pragma once

#include <filesystem>
#include <optional>

#include "device/usb/usb_io.hpp"

struct libusb_device;

namespace torsion::engine {

/// What a device says of itself, from what the system has read of it already: nothing is opened.
/// @return nothing where it has gone
std::optional<UsbIdentity> read_identity(libusb_device* device);

/// True where a HID interface of it had no kernel driver yet, which reads its report descriptor:
/// read_identity may say more another time.
bool may_say_more(const UsbIdentity& identity);

/// The device's folder in sysfs; empty where there is none.
std::filesystem::path sysfs_folder(const UsbIdentity& identity);

}  // namespace torsion::engine
