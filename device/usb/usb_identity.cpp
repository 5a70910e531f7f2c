#include "device/usb/usb_identity.hpp"

#include <span>

#include <libusb-1.0/libusb.h>

namespace torsion::engine {
namespace {

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
  return identity;
}

}  // namespace torsion::engine
