#pragma once

#include <array>
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

enum class HidReportKind : std::uint8_t { kInput, kOutput, kFeature };

/// One value in a device's reports, or one of the usages that an array there may be set to.
struct HidField {
  HidUsage usage = 0;
  HidUsage application = 0;      // of the outermost collection
  std::uint8_t report_id = 0;    // 0 where reports have no id
  std::uint32_t bit_offset = 0;  // from the first byte after the id
  std::uint32_t bit_size = 0;    // 1 to 32; 0: there is no such field
  std::int32_t logical_min = 0;
  std::int32_t logical_max = 0;
  HidReportKind kind = HidReportKind::kInput;
  std::uint32_t collection = 0;  // the innermost, of HidReports::collections
  std::int32_t chosen = 1;       // value that says "this usage"; of an array its number there
  std::uint32_t unit = 0;        // as in 6.2.2.7; 0: none
  std::int32_t unit_exponent = 0;
};

struct HidCollection {
  HidUsage usage = 0;
  std::uint32_t parent = 0;
};

/// What a report descriptor says: every variable field in the order of the bits, and of the arrays
/// that go out every usage.
struct HidReports {
  std::vector<HidField> fields;
  std::vector<HidCollection> collections{{}};  // the first is what is around all
  // Bits that each report has, without its id, by kind and id.
  std::array<std::array<std::uint32_t, 256>, 3> bits{};
  bool numbered = false;  // reports begin with a byte that is their id
};

/// Reads a report descriptor. Source: Device Class Definition for HID 1.11, section 6.2.2.
/// @return nothing where it is cut off, does not nest, or describes a report of over 64 KiB
std::optional<HidReports> parse_hid_descriptor(Bytes descriptor);

/// True where one of the collections round the field has this usage.
bool is_within(const HidReports& reports, const HidField& field, HidUsage collection);

/// The field's value in a report, sign extended where its range goes below zero.
/// @param report  with its id when `numbered`
/// @return nothing where the report is another or too short
std::optional<std::int32_t> hid_value(const HidField& field, bool numbered, Bytes report);

/// Writes the lowest bits of `value` into the field.
/// @param report  with its id when `numbered`
/// @return false, and the report as it was, where it is another or too short
bool put_hid_value(const HidField& field, bool numbered, std::int32_t value,
                   std::span<std::uint8_t> report);

}  // namespace torsion::engine
