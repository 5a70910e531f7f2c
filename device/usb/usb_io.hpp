#pragma once

// What passes between a driver and the bus: requests out, events back. A driver never waits and
// knows no library, so that it runs the same over libusb and over a bus that a test makes up.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/protocols/bytes.hpp"
#include "ecs/assert.hpp"

namespace torsion::engine {

inline constexpr std::uint8_t kUsbIn = 0x80;  // in an endpoint's address and a control's type
inline constexpr std::uint8_t kHidClass = 3;  // of interfaces

enum class UsbEndpointKind : std::uint8_t { kBulk, kInterrupt };

struct UsbEndpoint {
  std::uint8_t address = 0;
  UsbEndpointKind kind = UsbEndpointKind::kInterrupt;
  std::uint16_t packet_size = 0;  // bytes
};

struct UsbInterface {
  std::uint8_t number = 0;
  std::uint8_t device_class = 0;
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;  // of HID: 1 a keyboard, 2 a mouse
  std::vector<UsbEndpoint> endpoints;
  // Of HID: whether the system has read its report descriptor by now, and whether that has effects
  // of the PID class.
  bool is_described = false;
  bool plays_effects = false;
};

/// What a device says of itself, and where it is.
struct UsbIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint8_t bus = 0;
  std::uint8_t address = 0;
  std::vector<UsbInterface> interfaces;
};

enum class UsbJob : std::uint8_t { kRead, kWrite, kControl, kClaim, kRelease, kClearHalt };

enum class UsbStatus : std::uint8_t {
  kCompleted,
  kStall,     // the endpoint is halted until it is cleared
  kOverflow,  // more than was asked for
  kBroken,    // an error on the wire
  kTimedOut,
  kCancelled,
  kBusy,      // a claim: another program or driver has it
  kNoAccess,  // a claim: not allowed
  kGone,      // the device was pulled out
};

/// The setup packet of a control transfer. Source: USB 2.0, 9.3.
struct UsbSetup {
  std::uint8_t type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;  // of the data stage
};

inline constexpr std::size_t kLargestUsbWrite = 128;
inline constexpr std::size_t kLargestUsbRead = 4096;

struct UsbRequest {
  UsbJob job = UsbJob::kRead;
  std::uint8_t endpoint = 0;   // read, write, clear halt
  std::uint8_t interface = 0;  // claim, release
  std::uint16_t length = 0;    // read: room for this many bytes; write: how many
  bool may_take_long = false;  // write: not of a force, which is too old after 5 ms
  UsbSetup setup;              // control
  std::array<std::uint8_t, kLargestUsbWrite> bytes{};  // write, control out

  [[nodiscard]] Bytes data() const {
    return Bytes(bytes).first(job == UsbJob::kControl ? setup.length : length);
  }
};

/// The end of a request.
struct UsbEvent {
  UsbJob job = UsbJob::kRead;
  std::uint8_t endpoint = 0;
  std::uint8_t interface = 0;
  UsbSetup setup;
  UsbStatus status = UsbStatus::kCompleted;
  Bytes bytes;  // read, control in; only while the event is taken
};

/// The requests that one call of a driver makes, in their order.
struct UsbRequests {
  std::array<UsbRequest, 8> rows;
  std::size_t count = 0;

  UsbRequest& add(UsbJob job) {
    TORSION_ASSERT(count < rows.size());
    rows[count] = UsbRequest{};
    rows[count].job = job;
    return rows[count++];
  }
};

inline void read_usb(UsbRequests& requests, std::uint8_t endpoint, std::size_t length) {
  UsbRequest& request = requests.add(UsbJob::kRead);
  request.endpoint = endpoint;
  request.length = static_cast<std::uint16_t>(length);
}

/// @param may_take_long  it is no force, and the device may have to think
/// @pre bytes.size() <= kLargestUsbWrite
inline void write_usb(UsbRequests& requests, std::uint8_t endpoint, Bytes bytes,
                      bool may_take_long = false) {
  TORSION_ASSERT(bytes.size() <= kLargestUsbWrite);
  UsbRequest& request = requests.add(UsbJob::kWrite);
  request.endpoint = endpoint;
  request.length = static_cast<std::uint16_t>(bytes.size());
  request.may_take_long = may_take_long;
  std::ranges::copy(bytes, request.bytes.begin());
}

/// @param bytes  the data stage of a control that goes out; (setup.length)
inline void control_usb(UsbRequests& requests, const UsbSetup& setup, Bytes bytes = {}) {
  TORSION_ASSERT(bytes.size() <= kLargestUsbWrite);
  UsbRequest& request = requests.add(UsbJob::kControl);
  request.setup = setup;
  std::ranges::copy(bytes, request.bytes.begin());
}

inline void claim_usb(UsbRequests& requests, std::uint8_t interface) {
  requests.add(UsbJob::kClaim).interface = interface;
}

inline void release_usb(UsbRequests& requests, std::uint8_t interface) {
  requests.add(UsbJob::kRelease).interface = interface;
}

inline void clear_usb_halt(UsbRequests& requests, std::uint8_t endpoint) {
  requests.add(UsbJob::kClearHalt).endpoint = endpoint;
}

}  // namespace torsion::engine
