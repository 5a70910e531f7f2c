// What the kernel shows of an emulated device in sysfs while it is plugged in.

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "tests/device/mock_usb.hpp"

namespace torsion::engine::test {

void MockDevice::plug() {
  {
    const std::lock_guard lock(mutex_);
    driver_ = own_driver_;
    gone_ = false;
    packets_.clear();
    switch_on(device_);
  }
  if (!bound_) {
    // Before the device shows: its uevent may have it opened at once.
    umockdev_testbed_attach_ioctl(bed_, node_.c_str(), handler_, nullptr);
    bound_ = true;
  }
  std::string hex;
  for (const std::uint8_t byte : descriptors_of(device_)) {
    hex += fmt::format("{:02x}", byte);
  }
  const std::string description = fmt::format(
      "P: {0}\nN: bus/usb/001/{1:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\n"
      "E: DEVNUM={1:03}\nE: DEVNAME=/dev/bus/usb/001/{1:03}\nE: DEVTYPE=usb_device\n"
      "A: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum={1}\\n\nA: speed=12\\n\n"
      "H: descriptors={2}\n",
      sysfs_.substr(4), number_, hex);
  umockdev_testbed_add_from_string(bed_, description.c_str(), nullptr);
  for (const UsbInterface& interface : identity_of(device_).interfaces) {
    const std::string part = fmt::format(
        "P: {}/1-{}:1.{}\nE: SUBSYSTEM=usb\n"
        "E: DEVTYPE=usb_interface\n",
        sysfs_.substr(4), number_, interface.number);
    umockdev_testbed_add_from_string(bed_, part.c_str(), nullptr);
    show_driver(interface.number, own_driver_);
    if (interface.device_class == kHidClass) {
      show_report_descriptor(interface.number);
    }
  }
}

/// As the kernel's sysfs does. @param driver  empty: none
void MockDevice::show_driver(unsigned interface, const std::string& driver) const {
  namespace fs = std::filesystem;
  const fs::path link = fmt::format("{}{}/1-{}:1.{}/driver", root_, sysfs_, number_, interface);
  std::error_code ignored;
  fs::remove(link, ignored);
  if (!driver.empty()) {
    fs::create_symlink("../../../../bus/usb/drivers/" + driver, link, ignored);
  }
}

/// What usbhid has read of an interface while it has it.
void MockDevice::show_report_descriptor(std::uint8_t interface) {
  namespace fs = std::filesystem;
  constexpr UsbSetup kAsks{0x81, 6, 0x2200, 0, 4096};
  const auto descriptor = controlled(device_, kAsks, {});
  if (own_driver_ != "usbhid" || !descriptor) {
    return;
  }
  const UsbIdentity identity = identity_of(device_);
  const fs::path folder = fmt::format("{}{}/1-{}:1.{}/0003:{:04X}:{:04X}.0001", root_, sysfs_,
                                      number_, interface, identity.vendor, identity.product);
  fs::create_directories(folder);
  std::ofstream(folder / "new", std::ios::binary)
      .write(reinterpret_cast<const char*>(descriptor->data()),
             static_cast<std::streamsize>(descriptor->size()));
  fs::rename(folder / "new", folder / "report_descriptor");  // nobody reads a half of it
}

void MockDevice::unplug() {
  {
    const std::lock_guard lock(mutex_);
    gone_ = true;
    claims_.clear();
    for (std::deque<Urb>* const queue : {&reads_, &writes_}) {
      for (; !queue->empty(); queue->pop_front()) {  // the kernel gives all back; POLLERR does not
        finish(std::move(queue->front()), -ESHUTDOWN);  // come here
      }
    }
  }
  umockdev_testbed_uevent(bed_, sysfs_.c_str(), "remove");
  for (const UsbInterface& interface : identity_of(device_).interfaces) {
    show_driver(interface.number, "");
    umockdev_testbed_remove_device(
        bed_, fmt::format("{}/1-{}:1.{}", sysfs_, number_, interface.number).c_str());
  }
  umockdev_testbed_remove_device(bed_, sysfs_.c_str());
}

}  // namespace torsion::engine::test
