#include "device/usb/usb_port.hpp"

#include <algorithm>

#include <libusb-1.0/libusb.h>

namespace torsion::engine {
namespace {

// ms, of what goes out: a force that a device has not taken by then is too old, and one that lets
// go has to follow; set-up may take longer. Reads wait as long as it takes.
constexpr unsigned kForceTimeout = 5;
constexpr unsigned kTimeout = 500;
constexpr std::size_t kSetupSize = 8;

UsbStatus status_of(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return UsbStatus::kCompleted;
    case LIBUSB_TRANSFER_STALL:
      return UsbStatus::kStall;
    case LIBUSB_TRANSFER_OVERFLOW:
      return UsbStatus::kOverflow;
    case LIBUSB_TRANSFER_TIMED_OUT:
      return UsbStatus::kTimedOut;
    case LIBUSB_TRANSFER_CANCELLED:
      return UsbStatus::kCancelled;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return UsbStatus::kGone;
    default:
      return UsbStatus::kBroken;
  }
}

/// The endpoint's kind, as libusb counts.
unsigned char type_of(const UsbIdentity& identity, std::uint8_t address) {
  for (const UsbInterface& interface : identity.interfaces) {
    for (const UsbEndpoint& endpoint : interface.endpoints) {
      if (endpoint.address == address && endpoint.kind == UsbEndpointKind::kInterrupt) {
        return LIBUSB_TRANSFER_TYPE_INTERRUPT;
      }
    }
  }
  return LIBUSB_TRANSFER_TYPE_BULK;
}

void fill(UsbPort& port, UsbTransfer& transfer, const UsbRequest& request,
          libusb_transfer_cb_fn callback) {
  const bool in = request.job == UsbJob::kRead;
  if (request.job == UsbJob::kControl) {
    const UsbSetup& setup = request.setup;
    libusb_fill_control_setup(transfer.buffer.data(), setup.type, setup.request, setup.value,
                              setup.index, setup.length);
    if ((setup.type & kUsbIn) == 0) {
      std::ranges::copy(request.data(), transfer.buffer.begin() + kSetupSize);
    }
    libusb_fill_control_transfer(transfer.usb, port.handle, transfer.buffer.data(), callback,
                                 &transfer, kTimeout);
    return;
  }
  if (!in) {
    std::ranges::copy(request.data(), transfer.buffer.begin());
  }
  libusb_fill_bulk_transfer(transfer.usb, port.handle, request.endpoint, transfer.buffer.data(),
                            request.length, callback, &transfer,
                            in                      ? 0U
                            : request.may_take_long ? kTimeout
                                                    : kForceTimeout);
}

UsbEvent end_of(const UsbRequest& request) {
  UsbEvent event;
  event.job = request.job;
  event.endpoint = request.endpoint;
  event.interface = request.interface;
  event.setup = request.setup;
  return event;
}

void refuse(UsbPort& port, const UsbRequest& request) {
  UsbEvent event = end_of(request);
  event.status = UsbStatus::kBroken;
  port.refused.push_back(event);
}

}  // namespace

void prepare_port(UsbPort& port, void (*on_end)(libusb_transfer*)) {
  for (UsbTransfer& transfer : port.pool) {
    transfer.port = &port;
    transfer.usb = libusb_alloc_transfer(0);
    transfer.usb->callback = on_end;
  }
  port.refused.reserve(port.pool.size());
}

void free_transfers(UsbPort& port) {
  for (UsbTransfer& transfer : port.pool) {
    libusb_free_transfer(transfer.usb);
    transfer.usb = nullptr;
  }
}

void close_handle(UsbPort& port) {
  if (port.handle == nullptr) {
    return;
  }
  for (const UsbInterface& interface : port.identity.interfaces) {
    // Those never claimed and those of a device that has gone say so: no matter.
    libusb_release_interface(port.handle, interface.number);
  }
  libusb_close(port.handle);
  port.handle = nullptr;
}

bool submit(UsbPort& port, const UsbRequest& request) {
  auto* const free = std::ranges::find(port.pool, false, &UsbTransfer::under_way);
  if (free == port.pool.end()) {
    refuse(port, request);
    return true;
  }
  UsbTransfer& transfer = *free;
  fill(port, transfer, request, transfer.usb->callback);
  if (request.job != UsbJob::kControl) {
    transfer.usb->type = type_of(port.identity, request.endpoint);
  }
  transfer.event = end_of(request);
  const int error = libusb_submit_transfer(transfer.usb);
  if (error == LIBUSB_ERROR_NO_DEVICE) {
    return false;
  }
  if (error != 0) {
    refuse(port, request);
    return true;
  }
  transfer.under_way = true;
  port.under_way += 1;
  port.to_device += request.job == UsbJob::kRead ? 0U : 1U;
  return true;
}

void cancel_all(UsbPort& port) {
  for (UsbTransfer& transfer : port.pool) {
    if (transfer.under_way) {
      libusb_cancel_transfer(transfer.usb);  // one that has just ended says so, and its end comes
    }
  }
}

UsbEvent event_of(const UsbTransfer& transfer) {
  UsbEvent event = transfer.event;
  event.status = status_of(transfer.usb->status);
  const bool control = event.job == UsbJob::kControl;
  const bool in = control ? (event.setup.type & kUsbIn) != 0 : event.job == UsbJob::kRead;
  if (in && event.status == UsbStatus::kCompleted) {
    event.bytes = Bytes(transfer.buffer)
                      .subspan(control ? kSetupSize : 0,
                               static_cast<std::size_t>(transfer.usb->actual_length));
  }
  return event;
}

UsbStatus status_of_error(int error) {
  switch (error) {
    case 0:
      return UsbStatus::kCompleted;
    case LIBUSB_ERROR_ACCESS:
      return UsbStatus::kNoAccess;
    case LIBUSB_ERROR_BUSY:
      return UsbStatus::kBusy;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return UsbStatus::kGone;
    default:
      return UsbStatus::kBroken;
  }
}

}  // namespace torsion::engine
