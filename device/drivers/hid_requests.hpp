#pragma once

// What a HID interface is asked through the control pipe. Source: Device Class Definition for HID
// 1.11, 7.1.1 and 7.2.

#include "device/protocols/hid_descriptor.hpp"
#include "device/usb/usb_io.hpp"

namespace torsion::engine {

inline constexpr std::uint8_t kGetHidDescriptor = 6;
inline constexpr std::uint8_t kGetHidReport = 1;
inline constexpr std::uint8_t kSetHidReport = 9;

/// The type and id of a report, as requests name it.
inline std::uint16_t hid_report_value(HidReportKind kind, std::uint8_t id) {
  return static_cast<std::uint16_t>((static_cast<unsigned>(kind) + 1U) << 8U | id);
}

/// What it says of its reports.
inline void ask_report_descriptor(UsbRequests& requests, std::uint8_t interface) {
  constexpr std::uint16_t kReportDescriptor = 0x2200;
  constexpr std::uint16_t kLongest = 4000;  // bytes
  control_usb(requests, {0x81, kGetHidDescriptor, kReportDescriptor, interface, kLongest});
}

/// @param size  bytes, with the report's id
inline void get_hid_report(UsbRequests& requests, std::uint8_t interface, HidReportKind kind,
                           std::uint8_t id, std::size_t size) {
  control_usb(requests, {0xA1, kGetHidReport, hid_report_value(kind, id), interface,
                         static_cast<std::uint16_t>(size)});
}

/// @param report  with its id
inline void set_hid_report(UsbRequests& requests, std::uint8_t interface, HidReportKind kind,
                           std::uint8_t id, Bytes report) {
  control_usb(requests,
              {0x21, kSetHidReport, hid_report_value(kind, id), interface,
               static_cast<std::uint16_t>(report.size())},
              report);
}

}  // namespace torsion::engine
