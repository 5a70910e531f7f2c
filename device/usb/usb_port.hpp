#pragma once

// One open device of libusb: transfers under way in a pool of its own.

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "device/usb/usb_io.hpp"

struct libusb_device;
struct libusb_device_handle;
struct libusb_transfer;

namespace torsion::engine {

struct UsbPort;

struct UsbTransfer {
  UsbPort* port = nullptr;
  libusb_transfer* usb = nullptr;
  bool under_way = false;
  UsbEvent event;                                          // what it will be the end of
  std::array<std::uint8_t, 8 + kLargestUsbRead> buffer{};  // a control's setup is in front
};

enum class UsbPortState : std::uint8_t {
  kFree,
  kOpening,
  kRefused,  // not opened: will be tried again
  kOpen,
  kClosing,  // transfers come back, then it is closed
};

struct UsbPort {
  UsbPort() = default;
  UsbPort(const UsbPort&) = delete;
  UsbPort& operator=(const UsbPort&) = delete;
  UsbPort(UsbPort&&) = delete;
  UsbPort& operator=(UsbPort&&) = delete;
  ~UsbPort() = default;

  void* owner = nullptr;  // of the callbacks
  std::size_t row = 0;    // in the device loop
  UsbPortState state = UsbPortState::kFree;
  bool attached = false;  // the device loop knows it
  bool cancelled = false;
  bool looked_after = false;               // by the release process
  std::atomic<bool> left = false;          // the device has gone, perhaps while it is being opened
  libusb_device* device = nullptr;         // with a reference
  libusb_device_handle* handle = nullptr;  // written while nobody else looks at the port
  UsbIdentity identity;                    // likewise
  std::uint32_t under_way = 0;             // transfers
  std::uint32_t to_device = 0;             // of them those that go out
  std::uint32_t jobs = 0;                  // that may block, asked for and not yet done
  double retry_at = 0.0;                   // s: of kRefused
  std::uint32_t looks = 0;                 // at what the kernel may still find out about it
  std::vector<UsbEvent> refused;           // requests that the bus did not take
  std::array<UsbTransfer, 8> pool;
};

/// Makes the transfers of the pool. @param on_end  of libusb: its transfer's user_data is the
/// UsbTransfer
void prepare_port(UsbPort& port, void (*on_end)(libusb_transfer*));

/// Before the device is let go of: libusb looks at it once more. @pre none is under way
void free_transfers(UsbPort& port);

/// Gives the interfaces back and closes, if it is open. May block.
void close_handle(UsbPort& port);

/// Submits a read, write or control. What is not taken goes to `refused`.
/// @return false when the device has gone
bool submit(UsbPort& port, const UsbRequest& request);

/// Asks for all transfers to end.
void cancel_all(UsbPort& port);

/// The event that the end of a transfer is.
UsbEvent event_of(const UsbTransfer& transfer);

/// libusb's error of an open or a claim.
UsbStatus status_of_error(int error);

}  // namespace torsion::engine
