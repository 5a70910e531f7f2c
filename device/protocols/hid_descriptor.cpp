#include "device/protocols/hid_descriptor.hpp"

#include <algorithm>
#include <array>

namespace torsion::engine {
namespace {

constexpr std::uint32_t kMostBits = 8 * 65536;
constexpr std::uint32_t kMostFields = 4096;
constexpr std::size_t kDeepest = 32;  // nested collections, pushed states

// Item prefixes without their two bits of size: HID 1.11, 6.2.2.4, 6.2.2.7 and 6.2.2.8.
enum class Tag : std::uint8_t {
  kInput = 0x80,
  kOutput = 0x90,
  kFeature = 0xB0,
  kCollection = 0xA0,
  kEndCollection = 0xC0,
  kUsagePage = 0x04,
  kLogicalMinimum = 0x14,
  kLogicalMaximum = 0x24,
  kUnitExponent = 0x54,
  kUnit = 0x64,
  kReportSize = 0x74,
  kReportId = 0x84,
  kReportCount = 0x94,
  kPush = 0xA4,
  kPop = 0xB4,
  kUsage = 0x08,
  kUsageMinimum = 0x18,
  kUsageMaximum = 0x28,
};
constexpr std::uint8_t kLongItem = 0xFE;
constexpr std::uint32_t kConstant = 1;
constexpr std::uint32_t kVariable = 2;

struct Item {
  std::uint8_t tag = 0;
  std::size_t size = 0;  // bytes of data
  std::uint32_t data = 0;

  [[nodiscard]] std::int32_t signed_data() const {
    if (size == 0 || size == 4) {
      return static_cast<std::int32_t>(data);
    }
    const std::uint32_t sign = 1U << (8 * size - 1);
    return static_cast<std::int32_t>((data ^ sign) - sign);
  }
};

/// Takes the next item off the descriptor; false when it is cut off.
bool take_item(Bytes& rest, Item& item) {
  const std::uint8_t prefix = rest[0];
  if (prefix == kLongItem) {
    item = Item{};
    if (rest.size() < 3 || rest.size() < 3 + std::size_t{rest[1]}) {
      return false;
    }
    rest = rest.subspan(3 + std::size_t{rest[1]});
    return true;
  }
  item.tag = prefix & 0xFCU;
  item.size = (prefix & 3U) == 3U ? 4 : prefix & 3U;
  item.data = 0;
  if (rest.size() < 1 + item.size) {
    return false;
  }
  for (std::size_t i = 0; i < item.size; ++i) {
    item.data |= std::uint32_t{rest[1 + i]} << (8 * i);
  }
  rest = rest.subspan(1 + item.size);
  return true;
}

/// Items that hold until they are said anew.
struct Globals {
  std::uint32_t usage_page = 0;
  std::int32_t logical_min = 0;
  Item logical_max;  // signed or not as the minimum is
  std::int32_t unit_exponent = 0;
  std::uint32_t unit = 0;
  std::uint32_t report_size = 0;
  std::uint32_t report_count = 0;
  std::uint8_t report_id = 0;
};

struct Parser {
  Globals globals;
  std::vector<Globals> pushed;
  std::vector<HidUsage> usages;  // of the next main item
  HidUsage usage_min = 0;
  std::vector<std::uint32_t> open;  // collections, of reports.collections
  HidReports reports;

  /// A usage of up to two bytes belongs to the page in force.
  [[nodiscard]] HidUsage usage_of(const Item& item) const {
    return item.size == 4 ? item.data : globals.usage_page << 16 | item.data;
  }

  bool add_usages(HidUsage last) {
    if (last < usage_min || last - usage_min >= kMostFields) {
      return false;
    }
    // By number: the last usage may be the largest that there is.
    for (std::uint32_t i = 0; i <= last - usage_min; ++i) {
      usages.push_back(usage_min + i);
    }
    return usages.size() <= kMostFields;
  }

  [[nodiscard]] HidField field_at(HidReportKind kind, std::uint32_t bit_offset) const {
    HidField field;
    field.application = open.empty() ? 0 : reports.collections[open.front()].usage;
    field.report_id = globals.report_id;
    field.bit_offset = bit_offset;
    field.bit_size = globals.report_size;
    field.logical_min = globals.logical_min;
    field.logical_max = globals.logical_min < 0
                            ? globals.logical_max.signed_data()
                            : static_cast<std::int32_t>(globals.logical_max.data);
    field.kind = kind;
    field.collection = open.empty() ? 0 : open.back();
    field.unit = globals.unit;
    field.unit_exponent = globals.unit_exponent;
    return field;
  }

  bool add_fields(HidReportKind kind, std::uint32_t flags) {
    std::uint32_t& at = reports.bits[static_cast<std::size_t>(kind)][globals.report_id];
    const std::uint64_t all = std::uint64_t{globals.report_size} * globals.report_count;
    if (at + all > kMostBits) {
      return false;
    }
    const bool variable = (flags & kVariable) != 0;
    const bool chooses = !variable && kind != HidReportKind::kInput;
    const bool has_value = (flags & kConstant) == 0 && (variable || chooses) && !usages.empty() &&
                           globals.report_count > 0 && globals.report_size >= 1 &&
                           globals.report_size <= 32;
    const std::uint64_t count = !has_value ? 0
                                : variable ? std::uint64_t{globals.report_count}
                                           : usages.size();
    if (reports.fields.size() + count > kMostFields) {
      return false;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      HidField field = field_at(kind, variable ? at + i * globals.report_size : at);
      field.usage = usages[std::min<std::size_t>(i, usages.size() - 1)];
      field.chosen =
          variable ? 1 : static_cast<std::int32_t>(std::int64_t{globals.logical_min} + i);
      reports.fields.push_back(field);
    }
    at += static_cast<std::uint32_t>(all);
    return true;
  }

  bool open_collection() {
    const std::uint32_t parent = open.empty() ? 0 : open.back();
    reports.collections.push_back({usages.empty() ? 0 : usages.back(), parent});
    open.push_back(static_cast<std::uint32_t>(reports.collections.size() - 1));
    return open.size() <= kDeepest && reports.collections.size() <= kMostFields;
  }

  bool take_global(const Item& item) {
    switch (static_cast<Tag>(item.tag)) {
      case Tag::kUsagePage:
        globals.usage_page = item.data & 0xFFFFU;
        return true;
      case Tag::kLogicalMinimum:
        globals.logical_min = item.signed_data();
        return true;
      case Tag::kLogicalMaximum:
        globals.logical_max = item;
        return true;
      case Tag::kUnitExponent:
        // Four bits with a sign; some fill the byte up with it.
        globals.unit_exponent = static_cast<std::int32_t>((item.data & 0xFU) ^ 8U) - 8;
        return true;
      case Tag::kUnit:
        globals.unit = item.data;
        return true;
      case Tag::kReportSize:
        globals.report_size = item.data;
        return true;
      case Tag::kReportCount:
        globals.report_count = item.data;
        return true;
      case Tag::kReportId:
        globals.report_id = static_cast<std::uint8_t>(item.data);
        reports.numbered = true;
        return item.data >= 1 && item.data <= 255;
      case Tag::kPush:
        pushed.push_back(globals);
        return pushed.size() <= kDeepest;
      case Tag::kPop:
        if (pushed.empty()) {
          return false;
        }
        globals = pushed.back();
        pushed.pop_back();
        return true;
      default:
        return true;
    }
  }

  bool take_main(const Item& item) {
    bool good = true;
    switch (static_cast<Tag>(item.tag)) {
      case Tag::kInput:
        good = add_fields(HidReportKind::kInput, item.data);
        break;
      case Tag::kOutput:
        good = add_fields(HidReportKind::kOutput, item.data);
        break;
      case Tag::kFeature:
        good = add_fields(HidReportKind::kFeature, item.data);
        break;
      case Tag::kCollection:
        good = open_collection();
        break;
      case Tag::kEndCollection:
        good = !open.empty();
        if (good) {
          open.pop_back();
        }
        break;
      default:
        break;
    }
    usages.clear();
    usage_min = 0;
    return good;
  }

  bool take_local(const Item& item) {
    switch (static_cast<Tag>(item.tag)) {
      case Tag::kUsage:
        usages.push_back(usage_of(item));
        return usages.size() <= kMostFields;
      case Tag::kUsageMinimum:
        usage_min = usage_of(item);
        return true;
      case Tag::kUsageMaximum:
        return add_usages(usage_of(item));
      default:
        return true;
    }
  }

  bool take(const Item& item) {
    constexpr std::uint8_t kType = 0x0C;
    constexpr std::uint8_t kMain = 0x00;
    constexpr std::uint8_t kGlobal = 0x04;
    if (item.tag == 0) {
      return true;  // a long item, or nothing
    }
    if ((item.tag & kType) == kMain) {
      return take_main(item);
    }
    return (item.tag & kType) == kGlobal ? take_global(item) : take_local(item);
  }
};

}  // namespace

std::optional<HidReports> parse_hid_descriptor(Bytes descriptor) {
  Parser parser;
  Item item;
  while (!descriptor.empty()) {
    if (!take_item(descriptor, item) || !parser.take(item)) {
      return std::nullopt;
    }
  }
  if (!parser.open.empty()) {
    return std::nullopt;
  }
  return std::move(parser.reports);
}

bool is_within(const HidReports& reports, const HidField& field, HidUsage collection) {
  for (std::uint32_t i = field.collection; i != 0; i = reports.collections[i].parent) {
    if (reports.collections[i].usage == collection) {
      return true;
    }
  }
  return false;
}

std::optional<std::int32_t> hid_value(const HidField& field, bool numbered, Bytes report) {
  if (numbered) {
    if (report.empty() || report[0] != field.report_id) {
      return std::nullopt;
    }
    report = report.subspan(1);
  }
  if (field.bit_size == 0 || field.bit_size > 32 ||
      std::uint64_t{field.bit_offset} + field.bit_size > 8 * std::uint64_t{report.size()}) {
    return std::nullopt;
  }
  std::uint64_t bits = 0;
  const std::size_t first = field.bit_offset / 8;
  const std::size_t last = (field.bit_offset + field.bit_size - 1) / 8;
  for (std::size_t byte = first; byte <= last; ++byte) {
    bits |= std::uint64_t{report[byte]} << (8 * (byte - first));
  }
  bits = bits >> (field.bit_offset % 8) & ((std::uint64_t{1} << field.bit_size) - 1);
  if (field.logical_min < 0) {
    const std::uint64_t sign = std::uint64_t{1} << (field.bit_size - 1);
    bits = (bits ^ sign) - sign;
  }
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
}

bool put_hid_value(const HidField& field, bool numbered, std::int32_t value,
                   std::span<std::uint8_t> report) {
  if (numbered) {
    if (report.empty() || report[0] != field.report_id) {
      return false;
    }
    report = report.subspan(1);
  }
  if (std::uint64_t{field.bit_offset} + field.bit_size > 8 * std::uint64_t{report.size()}) {
    return false;
  }
  const auto bits = static_cast<std::uint32_t>(value);
  for (std::uint32_t i = 0; i < field.bit_size; ++i) {
    const std::uint32_t at = field.bit_offset + i;
    const auto mask = static_cast<std::uint8_t>(1U << at % 8);
    std::uint8_t& byte = report[at / 8];
    byte = static_cast<std::uint8_t>((bits >> i & 1U) != 0 ? byte | mask : byte & ~mask);
  }
  return true;
}

}  // namespace torsion::engine
