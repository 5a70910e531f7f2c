#include "device/usb/usb_list.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include "device/usb/usb_identity.hpp"
#include "device/usb/usb_port.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

/// The name of the driver that has an interface, from sysfs: libusb only says that there is one.
std::string driver_of(const fs::path& device, const UsbInterface& interface) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(device, error)) {
    const std::string name = entry.path().filename().string();
    if (name.find(fmt::format(":1.{}", interface.number)) != std::string::npos) {
      const fs::path driver = fs::read_symlink(entry.path() / "driver", error);
      return error ? "" : driver.filename().string();
    }
  }
  return "";
}

/// The programs that have the device's node open, as far as this user may look.
std::string holder_of(const UsbIdentity& identity) {
  const std::string node = fmt::format("/dev/bus/usb/{:03}/{:03}", identity.bus, identity.address);
  std::string holders;
  std::error_code error;
  for (const fs::directory_entry& process : fs::directory_iterator("/proc", error)) {
    std::error_code hidden;
    for (const fs::directory_entry& file : fs::directory_iterator(process.path() / "fd", hidden)) {
      // A container may have the nodes elsewhere: only the end of the path is the device's.
      if (!fs::read_symlink(file.path(), hidden).string().ends_with(node) || hidden) {
        continue;
      }
      std::string name;
      std::getline(std::ifstream(process.path() / "comm"), name);
      holders += fmt::format("{}{} (process {})", holders.empty() ? "" : ", ", name,
                             process.path().filename().string());
      break;
    }
  }
  return holders;
}

/// Tries what a session would do first, and takes it back.
void try_out(libusb_device* device, ListedDevice& listed) {
  libusb_device_handle* handle = nullptr;
  const int error = libusb_open(device, &handle);
  if (error != 0) {
    listed.access =
        error == LIBUSB_ERROR_ACCESS ? DeviceTrouble::kNoAccess : DeviceTrouble::kSilent;
    return;
  }
  const fs::path folder = sysfs_folder(listed.identity);
  for (const UsbInterface& interface : listed.identity.interfaces) {
    if (libusb_kernel_driver_active(handle, interface.number) == 1) {
      const std::string driver = driver_of(folder, interface);
      if (driver == "usbfs") {
        listed.access = DeviceTrouble::kHeldElsewhere;  // a program's claim looks like a driver
      } else {
        listed.kernel_drivers.push_back(driver.empty() ? "driver" : driver);
      }
      continue;
    }
    if (libusb_claim_interface(handle, interface.number) == LIBUSB_ERROR_BUSY) {
      listed.access = DeviceTrouble::kHeldElsewhere;
    } else {
      libusb_release_interface(handle, interface.number);
    }
  }
  libusb_close(handle);
  if (listed.access == DeviceTrouble::kHeldElsewhere) {
    listed.holder = holder_of(listed.identity);
    listed.holder = listed.holder.empty() ? "one of another user" : listed.holder;
  }
  std::ranges::sort(listed.kernel_drivers);
  listed.kernel_drivers.erase(
      std::unique(listed.kernel_drivers.begin(), listed.kernel_drivers.end()),
      listed.kernel_drivers.end());
}

}  // namespace

Result<std::vector<ListedDevice>> list_usb_devices() {
  libusb_context* context = nullptr;
  const int error = libusb_init(&context);
  if (error != 0) {
    return Error{std::string("USB cannot be used: ") + libusb_strerror(error)};
  }
  std::vector<ListedDevice> found;
  libusb_device** devices = nullptr;
  const auto count = libusb_get_device_list(context, &devices);
  for (libusb_device* device :
       std::span(devices, static_cast<std::size_t>(std::max<ssize_t>(count, 0)))) {
    const auto identity = read_identity(device);
    const auto kind = identity ? kind_of(*identity) : std::nullopt;
    if (kind) {
      ListedDevice listed;
      listed.kind = *kind;
      listed.identity = *identity;
      try_out(device, listed);
      found.push_back(std::move(listed));
    }
  }
  if (count >= 0) {
    libusb_free_device_list(devices, 1);
  }
  libusb_exit(context);
  return found;
}

}  // namespace torsion::engine
