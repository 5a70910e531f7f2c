#include "device/protocols/space_mouse.hpp"

#include <algorithm>

namespace torsion::engine {
namespace {

constexpr std::uint16_t kLogitech = 0x046D;
constexpr std::int32_t kUsualDeflection = 350;
constexpr std::uint32_t kAxisBits = 16;

HidField usual_axis(std::uint32_t axis) {
  const std::uint32_t in_report = axis % 3;
  return {kHidX + axis,
          kHidMultiAxisController,
          axis < 3 ? std::uint8_t{1} : std::uint8_t{2},
          kAxisBits * in_report,
          kAxisBits,
          -kUsualDeflection,
          kUsualDeflection};
}

/// The devices have x to the right, y towards the user and z down; the oldest y up and z away.
glm::dvec3 y_up(const SpaceMouseLayout& layout, const glm::dvec3& raw) {
  return layout.oldest_axes ? glm::dvec3(raw.x, raw.y, -raw.z) : glm::dvec3(raw.x, -raw.z, raw.y);
}

glm::dvec3 raw_axes(const SpaceMouseLayout& layout, const glm::dvec3& y_up) {
  return layout.oldest_axes ? glm::dvec3(y_up.x, y_up.y, -y_up.z)
                            : glm::dvec3(y_up.x, y_up.z, -y_up.y);
}

double share_of(const HidField& axis, std::int32_t value) {
  const double full = std::max(std::abs(static_cast<double>(axis.logical_max)),
                               std::abs(static_cast<double>(axis.logical_min)));
  return full > 0.0 ? std::clamp(static_cast<double>(value) / full, -1.0, 1.0) : 0.0;
}

}  // namespace

std::optional<SpaceMouseLayout> space_mouse_layout(const HidReports& reports) {
  SpaceMouseLayout layout;
  layout.numbered = reports.numbered;
  for (const HidField& field : reports.fields) {
    if (field.application != kHidMultiAxisController || field.kind != HidReportKind::kInput) {
      continue;
    }
    const std::uint32_t axis = field.usage - kHidX;  // wraps round below
    if (axis < layout.axes.size() && layout.axes[axis].bit_size == 0) {
      layout.axes[axis] = field;
    } else if (field.usage >> 16 == kHidButtonPage && layout.button_count < layout.buttons.size()) {
      layout.buttons[layout.button_count++] = field;
    }
  }
  const bool complete =
      std::ranges::all_of(layout.axes, [](const HidField& axis) { return axis.bit_size != 0; });
  return complete ? std::optional(layout) : std::nullopt;
}

SpaceMouseLayout usual_space_mouse_layout() {
  constexpr std::uint32_t kButtons = 32;
  SpaceMouseLayout layout;
  for (std::uint32_t axis = 0; axis < layout.axes.size(); ++axis) {
    layout.axes[axis] = usual_axis(axis);
  }
  for (; layout.button_count < kButtons; ++layout.button_count) {
    layout.buttons[layout.button_count] = {
        (HidUsage{kHidButtonPage} << 16) + layout.button_count + 1,
        kHidMultiAxisController,
        3,
        layout.button_count,
        1,
        0,
        1};
  }
  return layout;
}

bool take_space_mouse_report(const SpaceMouseLayout& layout, Bytes report, SpaceMouseState& state) {
  std::array<double, 6> raw{};
  const glm::dvec3 translation = raw_axes(layout, state.translation);
  const glm::dvec3 rotation = raw_axes(layout, state.rotation);
  for (std::size_t i = 0; i < 3; ++i) {
    raw[i] = translation[static_cast<glm::length_t>(i)];
    raw[i + 3] = rotation[static_cast<glm::length_t>(i)];
  }
  // Newer devices send the rotation behind the translation, whatever an old layout says.
  constexpr std::size_t kLongReport = 13;  // id and six axes
  const bool both = layout.numbered && report.size() >= kLongReport && report[0] == 1 &&
                    layout.axes[0].report_id == 1 && layout.axes[3].report_id == 2;
  bool any = false;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    HidField axis = layout.axes[i];
    if (both && i >= 3) {
      axis.report_id = 1;
      axis.bit_offset += 3 * kAxisBits;
    }
    if (const auto value = hid_value(axis, layout.numbered, report)) {
      raw[i] = share_of(axis, *value);
      any = true;
    } else if (layout.numbered && !report.empty() && report[0] == axis.report_id) {
      return false;  // cut off: what is there of it may be wrong, too
    }
  }
  std::uint32_t buttons = state.buttons;
  for (std::uint32_t i = 0; i < layout.button_count; ++i) {
    if (const auto value = hid_value(layout.buttons[i], layout.numbered, report)) {
      const std::uint32_t bit = 1U << i;
      buttons = *value != 0 ? buttons | bit : buttons & ~bit;
      any = true;
    }
  }
  state.translation = y_up(layout, {raw[0], raw[1], raw[2]});
  state.rotation = y_up(layout, {raw[3], raw[4], raw[5]});
  state.buttons = buttons;
  return any;
}

bool is_other_report(Bytes report) {
  constexpr std::uint8_t kBattery = 0x17;
  constexpr std::uint8_t kReceiver = 0x1C;
  return !report.empty() && (report[0] == kBattery || report[0] == kReceiver);
}

bool has_oldest_axes(std::uint16_t vendor, std::uint16_t product) {
  return vendor == kLogitech && (product == 0xC603 || product == 0xC606);
}

bool is_not_a_space_mouse(std::uint16_t vendor, std::uint16_t product) {
  // CadMouse, Keyboard Pro, Numpad Pro
  constexpr std::array<std::uint16_t, 10> kOthers = {0xC650, 0xC651, 0xC654, 0xC655, 0xC656,
                                                     0xC657, 0xC658, 0xC664, 0xC665, 0xC668};
  return vendor == k3Dconnexion && std::ranges::find(kOthers, product) != kOthers.end();
}

bool is_space_mouse(std::uint16_t vendor, std::uint16_t product) {
  constexpr std::array<std::uint16_t, 12> kByLogitech = {0xC603, 0xC605, 0xC606, 0xC621,
                                                         0xC623, 0xC625, 0xC626, 0xC627,
                                                         0xC628, 0xC629, 0xC62B, 0xC640};
  constexpr std::array<std::uint16_t, 13> kBy3Dconnexion = {0xC62E, 0xC62F, 0xC631, 0xC632, 0xC633,
                                                            0xC635, 0xC636, 0xC638, 0xC63A, 0xC641,
                                                            0xC652, 0xC65A, 0xC65C};
  const auto among = [product](const auto& ids) {
    return std::ranges::find(ids, product) != ids.end();
  };
  return (vendor == kLogitech && among(kByLogitech)) ||
         (vendor == k3Dconnexion && among(kBy3Dconnexion));
}

}  // namespace torsion::engine
