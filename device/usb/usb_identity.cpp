#include "device/usb/usb_identity.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <span>

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include "device/protocols/wheel.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

int number_in(const fs::path& file) {
  std::ifstream stream(file);
  int number = -1;
  stream >> number;
  return number;
}

/// An interface's report descriptor, as the kernel's driver has read it; empty where none has.
std::vector<std::uint8_t> report_descriptor(const fs::path& device, std::uint8_t interface) {
  const std::string ending = fmt::format(":1.{}", interface);
  std::error_code error;
  for (const fs::directory_entry& part : fs::directory_iterator(device, error)) {
    if (!part.path().filename().string().ends_with(ending)) {
      continue;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(part.path(), error)) {
      std::ifstream file(entry.path() / "report_descriptor", std::ios::binary);
      if (file) {
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
      }
    }
  }
  return {};
}

bool plays_effects(const std::vector<std::uint8_t>& descriptor) {
  const auto reports = descriptor.empty() ? std::nullopt : parse_hid_descriptor(descriptor);
  return reports && has_effects(*reports);
}

UsbInterface read_interface(const libusb_interface_descriptor& from) {
  UsbInterface to;
  to.number = from.bInterfaceNumber;
  to.device_class = from.bInterfaceClass;
  to.subclass = from.bInterfaceSubClass;
  to.protocol = from.bInterfaceProtocol;
  for (const libusb_endpoint_descriptor& endpoint : std::span(from.endpoint, from.bNumEndpoints)) {
    const int kind = endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK;
    if (kind == LIBUSB_TRANSFER_TYPE_BULK || kind == LIBUSB_TRANSFER_TYPE_INTERRUPT) {
      to.endpoints.push_back(
          {endpoint.bEndpointAddress,
           kind == LIBUSB_TRANSFER_TYPE_BULK ? UsbEndpointKind::kBulk : UsbEndpointKind::kInterrupt,
           endpoint.wMaxPacketSize});
    }
  }
  return to;
}

}  // namespace

std::optional<UsbIdentity> read_identity(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  if (libusb_get_device_descriptor(device, &descriptor) != 0) {
    return std::nullopt;
  }
  UsbIdentity identity;
  identity.vendor = descriptor.idVendor;
  identity.product = descriptor.idProduct;
  identity.bus = libusb_get_bus_number(device);
  identity.address = libusb_get_device_address(device);
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != 0) {
    return identity;  // not configured: it has no interfaces to use
  }
  for (const libusb_interface& interface : std::span(config->interface, config->bNumInterfaces)) {
    if (interface.num_altsetting > 0) {
      identity.interfaces.push_back(read_interface(interface.altsetting[0]));
    }
  }
  libusb_free_config_descriptor(config);
  fs::path folder;
  for (UsbInterface& interface : identity.interfaces) {
    if (interface.device_class == kHidClass) {
      folder = folder.empty() ? sysfs_folder(identity) : folder;
      const std::vector<std::uint8_t> said = report_descriptor(folder, interface.number);
      interface.is_described = !said.empty();
      interface.plays_effects = plays_effects(said);
    }
  }
  return identity;
}

bool may_say_more(const UsbIdentity& identity) {
  return std::ranges::any_of(identity.interfaces, [](const UsbInterface& interface) {
    return interface.device_class == kHidClass && !interface.is_described;
  });
}

fs::path sysfs_folder(const UsbIdentity& identity) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator("/sys/bus/usb/devices", error)) {
    if (number_in(entry.path() / "busnum") == identity.bus &&
        number_in(entry.path() / "devnum") == identity.address) {
      return entry.path();
    }
  }
  return {};
}

}  // namespace torsion::engine
