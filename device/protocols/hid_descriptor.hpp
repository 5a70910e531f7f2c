#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/protocols/bytes.hpp"

namespace torsion::engine {

/// A usage of the HID usage tables with its page in the upper half.
using HidUsage = std::uint32_t;

inline constexpr HidUsage kHidMultiAxisController = 0x0001'0008;  // generic desktop
inline constexpr HidUsage kHidX = 0x0001'0030;                    // then Y, Z, Rx, Ry, Rz
inline constexpr std::uint16_t kHidButtonPage = 0x0009;

/// One value in a device's input reports.
struct HidField {
  HidUsage usage = 0;
  HidUsage application = 0;      // of the outermost collection
  std::uint8_t report_id = 0;    // 0 where reports have no id
  std::uint32_t bit_offset = 0;  // from the first byte after the id
  std::uint32_t bit_size = 0;    // 1 to 32
  std::int32_t logical_min = 0;
  std::int32_t logical_max = 0;
};

/// What a report descriptor says of input reports: every variable field, in the order of the bits.
struct HidInputs {
  std::vector<HidField> fields;
  bool numbered = false;  // reports begin with a byte that is their id
};

/// Reads a report descriptor. Source: Device Class Definition for HID 1.11, section 6.2.2.
/// @return nothing where it is cut off, does not nest, or describes a report of over 64 KiB
std::optional<HidInputs> parse_hid_descriptor(Bytes descriptor);

/// The field's value in a report, sign extended where its range goes below zero.
/// @param report  with its id when `numbered`
/// @return nothing where the report is another or too short
std::optional<std::int32_t> hid_value(const HidField& field, bool numbered, Bytes report);

}  // namespace torsion::engine
