#include "device/protocols/wheel.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace torsion::engine {
namespace {

constexpr HidUsage kSteering = 0x0002'00C8;  // simulation controls

// Physical Interface Device page. Source: PID 1.0, 4; HID usage tables.
constexpr HidUsage kSetEffectReport = 0x000F'0021;
constexpr HidUsage kEffectBlockIndex = 0x000F'0022;
constexpr HidUsage kConstantForce = 0x000F'0026;
constexpr HidUsage kDuration = 0x000F'0050;
constexpr HidUsage kGain = 0x000F'0052;
constexpr HidUsage kAxesEnable = 0x000F'0055;
constexpr HidUsage kDirectionEnable = 0x000F'0056;
constexpr HidUsage kDirection = 0x000F'0057;
constexpr HidUsage kMagnitude = 0x000F'0070;
constexpr HidUsage kSetConstantForceReport = 0x000F'0073;
constexpr HidUsage kEffectOperationReport = 0x000F'0077;
constexpr HidUsage kStart = 0x000F'0079;
constexpr HidUsage kStop = 0x000F'007B;
constexpr HidUsage kLoopCount = 0x000F'007C;
constexpr HidUsage kDeviceGainReport = 0x000F'007D;
constexpr HidUsage kDeviceGain = 0x000F'007E;
constexpr HidUsage kBlockLoadReport = 0x000F'0089;
constexpr HidUsage kBlockLoadSuccess = 0x000F'008C;
constexpr HidUsage kDeviceControl = 0x000F'0096;
constexpr HidUsage kEnableActuators = 0x000F'0097;
constexpr HidUsage kDeviceReset = 0x000F'009A;
constexpr HidUsage kActuatorsEnabled = 0x000F'00A0;
constexpr HidUsage kActuatorPower = 0x000F'00A6;
constexpr HidUsage kCreateNewEffectReport = 0x000F'00AB;

constexpr std::uint32_t kUnitsOfTime = 0xF000;  // nibble of the unit: seconds to some power
constexpr std::int32_t kMilliseconds = -3;

bool is_there(const HidField& field) {
  return field.bit_size > 0;
}

/// Finds fields of one kind of reports.
struct Finder {
  const HidReports& reports;
  HidReportKind kind;

  /// The first of this usage in such a collection; one without bits where there is none.
  [[nodiscard]] HidField field(HidUsage usage, HidUsage within) const {
    const auto found = std::ranges::find_if(reports.fields, [&](const HidField& one) {
      return one.kind == kind && one.usage == usage && is_within(reports, one, within);
    });
    return found != reports.fields.end() ? *found : HidField{};
  }
  /// The first in a collection, whatever it is called.
  [[nodiscard]] HidField first(HidUsage within) const {
    const auto found = std::ranges::find_if(reports.fields, [&](const HidField& one) {
      return one.kind == kind && is_within(reports, one, within);
    });
    return found != reports.fields.end() ? *found : HidField{};
  }
  [[nodiscard]] WheelReport report(const HidField& field) const {
    if (!is_there(field)) {
      return {};
    }
    const std::uint32_t bits = reports.bits[static_cast<std::size_t>(kind)][field.report_id];
    return {field.report_id, (bits + 7) / 8 + (reports.numbered ? 1U : 0U)};
  }
};

/// Leaves out what lies in another report: it cannot be said in the same packet.
void keep_within(const WheelReport& report, std::initializer_list<HidField*> fields) {
  for (HidField* const field : fields) {
    if (field->report_id != report.id) {
      *field = {};
    }
  }
}

void find_inputs(const HidReports& reports, WheelLayout& layout) {
  for (const HidField& field : reports.fields) {
    if (field.kind != HidReportKind::kInput) {
      continue;
    }
    const bool better = field.usage == kSteering && layout.turn.usage != kSteering;
    if (better || (field.usage == kHidX && !is_there(layout.turn))) {
      layout.turn = field;
    } else if (field.usage >> 16 == kHidButtonPage && layout.button_count < layout.buttons.size()) {
      layout.buttons[layout.button_count++] = field;
    } else if (field.usage == kActuatorsEnabled) {
      layout.enabled = field;
    } else if (field.usage == kActuatorPower) {
      layout.powered = field;
    }
  }
}

void find_outputs(const HidReports& reports, WheelLayout& layout) {
  const Finder out{reports, HidReportKind::kOutput};
  layout.effect_block = out.field(kEffectBlockIndex, kSetEffectReport);
  layout.effect_constant = out.field(kConstantForce, kSetEffectReport);
  layout.duration = out.field(kDuration, kSetEffectReport);
  layout.effect_gain = out.field(kGain, kSetEffectReport);
  layout.axis = out.field(kHidX, kAxesEnable);
  layout.has_direction = out.field(kDirectionEnable, kSetEffectReport);
  layout.direction = out.first(kDirection);
  layout.effect = out.report(layout.effect_block);
  layout.constant_block = out.field(kEffectBlockIndex, kSetConstantForceReport);
  layout.magnitude = out.field(kMagnitude, kSetConstantForceReport);
  layout.constant = out.report(layout.magnitude);
  layout.operation_block = out.field(kEffectBlockIndex, kEffectOperationReport);
  layout.start = out.field(kStart, kEffectOperationReport);
  layout.stop = out.field(kStop, kEffectOperationReport);
  layout.loops = out.field(kLoopCount, kEffectOperationReport);
  layout.operation = out.report(layout.start);
  layout.enable = out.field(kEnableActuators, kDeviceControl);
  layout.reset = out.field(kDeviceReset, kDeviceControl);
  layout.control = out.report(layout.enable);
  layout.device_gain = out.field(kDeviceGain, kDeviceGainReport);
  layout.gain = out.report(layout.device_gain);
  keep_within(layout.effect, {&layout.effect_constant, &layout.duration, &layout.effect_gain,
                              &layout.axis, &layout.has_direction, &layout.direction});
  keep_within(layout.constant, {&layout.constant_block});
  keep_within(layout.operation, {&layout.operation_block, &layout.stop, &layout.loops});
  keep_within(layout.control, {&layout.reset});
}

void find_features(const HidReports& reports, WheelLayout& layout) {
  const Finder feature{reports, HidReportKind::kFeature};
  layout.create_constant = feature.field(kConstantForce, kCreateNewEffectReport);
  layout.create = feature.report(layout.create_constant);
  layout.load_block = feature.field(kEffectBlockIndex, kBlockLoadReport);
  layout.load_success = feature.field(kBlockLoadSuccess, kBlockLoadReport);
  layout.load = feature.report(layout.load_block);
  keep_within(layout.load, {&layout.load_success});
}

bool is_complete(const WheelLayout& layout) {
  const bool all_there = std::ranges::all_of(
      std::array{&layout.turn, &layout.effect_block, &layout.effect_constant, &layout.duration,
                 &layout.constant_block, &layout.magnitude, &layout.operation_block, &layout.start,
                 &layout.stop, &layout.enable, &layout.create_constant, &layout.load_block,
                 &layout.load_success},
      [](const HidField* field) { return is_there(*field); });
  const bool all_fit = std::ranges::all_of(
      std::array{&layout.effect, &layout.constant, &layout.operation, &layout.control, &layout.gain,
                 &layout.create, &layout.load},
      [](const WheelReport* report) { return report->size <= kLargestWheelReport; });
  const bool has_range = layout.turn.logical_max > layout.turn.logical_min;
  const bool both_signs = layout.magnitude.logical_min < 0 && layout.magnitude.logical_max > 0;
  return all_there && all_fit && has_range && both_signs;
}

WheelPacket empty_packet(const WheelLayout& layout, const WheelReport& report) {
  WheelPacket packet;
  packet.size = report.size;
  if (layout.numbered && packet.size > 0) {
    packet.bytes[0] = report.id;
  }
  return packet;
}

/// Writes a value that is within the field's range; nothing where there is no such field.
void put(const WheelLayout& layout, WheelPacket& packet, const HidField& field, double value) {
  if (is_there(field)) {
    const double within = std::clamp(value, static_cast<double>(field.logical_min),
                                     static_cast<double>(field.logical_max));
    put_hid_value(field, layout.numbered, static_cast<std::int32_t>(std::lround(within)),
                  std::span(packet.bytes).first(packet.size));
  }
}

void choose(const WheelLayout& layout, WheelPacket& packet, const HidField& field) {
  if (is_there(field)) {
    put_hid_value(field, layout.numbered, field.chosen, std::span(packet.bytes).first(packet.size));
  }
}

WheelPacket encode_operation(const WheelLayout& layout, std::int32_t block, const HidField& what,
                             double loops) {
  WheelPacket packet = empty_packet(layout, layout.operation);
  put(layout, packet, layout.operation_block, block);
  choose(layout, packet, what);
  put(layout, packet, layout.loops, loops);
  return packet;
}

}  // namespace

bool has_effects(const HidReports& reports) {
  return std::ranges::any_of(reports.fields, [&](const HidField& field) {
    return field.kind == HidReportKind::kOutput && field.usage == kMagnitude &&
           is_within(reports, field, kSetConstantForceReport);
  });
}

std::optional<WheelLayout> wheel_layout(const HidReports& reports) {
  WheelLayout layout;
  layout.numbered = reports.numbered;
  find_inputs(reports, layout);
  layout.place = Finder{reports, HidReportKind::kInput}.report(layout.turn);
  find_outputs(reports, layout);
  find_features(reports, layout);
  return is_complete(layout) ? std::optional(layout) : std::nullopt;
}

WheelPacket encode_wheel_effect(const WheelLayout& layout, std::int32_t block, double duration) {
  WheelPacket packet = empty_packet(layout, layout.effect);
  const bool says_unit = (layout.duration.unit & kUnitsOfTime) != 0;
  const std::int32_t exponent = says_unit ? layout.duration.unit_exponent : kMilliseconds;
  put(layout, packet, layout.effect_block, block);
  choose(layout, packet, layout.effect_constant);
  // 0 would be for ever.
  put(layout, packet, layout.duration, std::max(1.0, duration / std::pow(10.0, exponent)));
  put(layout, packet, layout.effect_gain, layout.effect_gain.logical_max);
  if (is_there(layout.has_direction) && is_there(layout.direction)) {
    // From the east: a torque that is positive pushes to the west, against X. The field's range is
    // a whole turn.
    const double west = 0.75 * layout.direction.logical_min + 0.25 * layout.direction.logical_max;
    choose(layout, packet, layout.has_direction);
    put(layout, packet, layout.direction, west);
  } else {
    choose(layout, packet, layout.axis);
  }
  return packet;
}

WheelPacket encode_wheel_torque(const WheelLayout& layout, std::int32_t block, double share) {
  WheelPacket packet = empty_packet(layout, layout.constant);
  const double full = std::min(-static_cast<double>(layout.magnitude.logical_min),
                               static_cast<double>(layout.magnitude.logical_max));
  put(layout, packet, layout.constant_block, block);
  put(layout, packet, layout.magnitude,
      full * (std::isfinite(share) ? std::clamp(share, -1.0, 1.0) : 0.0));
  return packet;
}

WheelPacket encode_wheel_start(const WheelLayout& layout, std::int32_t block) {
  return encode_operation(layout, block, layout.start, 1.0);
}

WheelPacket encode_wheel_stop(const WheelLayout& layout, std::int32_t block) {
  return encode_operation(layout, block, layout.stop, 0.0);
}

WheelPacket encode_wheel_reset(const WheelLayout& layout) {
  if (!is_there(layout.reset)) {
    return {};
  }
  WheelPacket packet = empty_packet(layout, layout.control);
  choose(layout, packet, layout.reset);
  return packet;
}

WheelPacket encode_wheel_enable(const WheelLayout& layout) {
  WheelPacket packet = empty_packet(layout, layout.control);
  choose(layout, packet, layout.enable);
  return packet;
}

WheelPacket encode_wheel_gain(const WheelLayout& layout) {
  WheelPacket packet = empty_packet(layout, layout.gain);
  put(layout, packet, layout.device_gain, layout.device_gain.logical_max);
  return packet;
}

WheelPacket encode_wheel_create(const WheelLayout& layout) {
  WheelPacket packet = empty_packet(layout, layout.create);
  choose(layout, packet, layout.create_constant);
  return packet;
}

std::optional<std::int32_t> decode_wheel_load(const WheelLayout& layout, Bytes report) {
  const auto status = hid_value(layout.load_success, layout.numbered, report);
  const auto block = hid_value(layout.load_block, layout.numbered, report);
  const bool made = status && *status == layout.load_success.chosen && block && *block > 0;
  return made ? block : std::nullopt;
}

bool is_of_place(const WheelLayout& layout, Bytes report) {
  return !layout.numbered || (!report.empty() && report[0] == layout.place.id);
}

std::string_view wheel_error_text(std::uint32_t error) {
  return error == kWheelWithoutPower ? "it says that its motor has no power; is it plugged in?"
                                     : "it says that it was switched off: by a button of its own, "
                                       "or by its maker's program";
}

bool take_wheel_report(const WheelLayout& layout, Bytes report, WheelState& state) {
  const auto value_of = [&](const HidField& field) {
    return is_there(field) ? hid_value(field, layout.numbered, report) : std::nullopt;
  };
  if (is_of_place(layout, report) && report.size() < layout.place.size) {
    return false;
  }
  bool any = false;
  if (const auto count = value_of(layout.turn)) {
    const double lowest = layout.turn.logical_min;
    const double highest = layout.turn.logical_max;
    state.count = *count;
    state.turn = std::clamp(2.0 * (*count - lowest) / (highest - lowest) - 1.0, -1.0, 1.0);
    any = true;
  }
  for (std::uint32_t i = 0; i < layout.button_count; ++i) {
    if (const auto value = value_of(layout.buttons[i])) {
      const std::uint32_t bit = 1U << i;
      state.buttons = *value != 0 ? state.buttons | bit : state.buttons & ~bit;
      any = true;
    }
  }
  if (const auto enabled = value_of(layout.enabled)) {
    state.enabled = *enabled != 0;
    any = true;
  }
  if (const auto powered = value_of(layout.powered)) {
    state.powered = *powered != 0;
    any = true;
  }
  return any;
}

}  // namespace torsion::engine
