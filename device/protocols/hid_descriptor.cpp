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
  kCollection = 0xA0,
  kEndCollection = 0xC0,
  kUsagePage = 0x04,
  kLogicalMinimum = 0x14,
  kLogicalMaximum = 0x24,
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
  std::uint32_t report_size = 0;
  std::uint32_t report_count = 0;
  std::uint8_t report_id = 0;
};

struct Parser {
  Globals globals;
  std::vector<Globals> pushed;
  std::vector<HidUsage> usages;  // of the next main item
  HidUsage usage_min = 0;
  std::vector<HidUsage> collections;
  std::array<std::uint32_t, 256> bits{};  // so far, of each report
  HidInputs inputs;

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

  bool add_input(std::uint32_t flags) {
    std::uint32_t& at = bits[globals.report_id];
    const std::uint64_t all = std::uint64_t{globals.report_size} * globals.report_count;
    if (at + all > kMostBits) {
      return false;
    }
    const bool has_value = (flags & kConstant) == 0 && (flags & kVariable) != 0 &&
                           !usages.empty() && globals.report_size >= 1 && globals.report_size <= 32;
    if (has_value && inputs.fields.size() + globals.report_count > kMostFields) {
      return false;
    }
    const bool below_zero = globals.logical_min < 0;
    for (std::uint32_t i = 0; has_value && i < globals.report_count; ++i) {
      inputs.fields.push_back({usages[std::min<std::size_t>(i, usages.size() - 1)],
                               collections.empty() ? 0 : collections.front(), globals.report_id,
                               at + i * globals.report_size, globals.report_size,
                               globals.logical_min,
                               below_zero ? globals.logical_max.signed_data()
                                          : static_cast<std::int32_t>(globals.logical_max.data)});
    }
    at += static_cast<std::uint32_t>(all);
    return true;
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
      case Tag::kReportSize:
        globals.report_size = item.data;
        return true;
      case Tag::kReportCount:
        globals.report_count = item.data;
        return true;
      case Tag::kReportId:
        globals.report_id = static_cast<std::uint8_t>(item.data);
        inputs.numbered = true;
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
        good = add_input(item.data);
        break;
      case Tag::kCollection:
        collections.push_back(usages.empty() ? 0 : usages.back());
        good = collections.size() <= kDeepest;
        break;
      case Tag::kEndCollection:
        good = !collections.empty();
        if (good) {
          collections.pop_back();
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

std::optional<HidInputs> parse_hid_descriptor(Bytes descriptor) {
  Parser parser;
  Item item;
  while (!descriptor.empty()) {
    if (!take_item(descriptor, item) || !parser.take(item)) {
      return std::nullopt;
    }
  }
  if (!parser.collections.empty()) {
    return std::nullopt;
  }
  return std::move(parser.inputs);
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

}  // namespace torsion::engine
