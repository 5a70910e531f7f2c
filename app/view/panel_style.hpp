#pragma once

// What the files that build panels share.

#include <algorithm>
#include <string>

#include <imgui.h>

namespace torsion::engine {

inline constexpr ImU32 kRed = IM_COL32(200, 45, 45, 255);  // something is wrong
// As the arrows of the force, of the torque, and of the couples apart from it.
inline constexpr ImU32 kForceInk = IM_COL32(39, 111, 196, 255);
inline constexpr ImU32 kTorqueInk = IM_COL32(204, 115, 0, 255);
inline constexpr ImU32 kCoupleInk = IM_COL32(149, 48, 173, 255);
// Curves side by side: told apart by their lightness too, in grey and by the colour-blind.
inline constexpr ImU32 kDarkCurve = IM_COL32(15, 50, 110, 255);
inline constexpr ImU32 kMiddleCurve = IM_COL32(176, 78, 148, 255);
inline constexpr ImU32 kLightCurve = IM_COL32(86, 180, 233, 255);
inline constexpr ImU32 kGreyCurve = IM_COL32(165, 168, 175, 255);
// Cells that stick and cells that slip: dark and bright.
inline constexpr ImU32 kSticksInk = IM_COL32(15, 50, 70, 255);
inline constexpr ImU32 kSlipsInk = IM_COL32(255, 205, 0, 255);
// A panel that appears takes no focus: a button that is held down would lose its click.
inline constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing;

inline void text(const std::string& line) {
  ImGui::TextUnformatted(line.c_str());
}

inline void dim(const std::string& line) {
  ImGui::TextDisabled("%s", line.c_str());
}

inline void text_in(ImU32 color, const std::string& line) {
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color), "%s", line.c_str());
}

/// A slider and a field for its value.
inline bool slider(const char* label, double& value, double low, double high, const char* format,
                   bool logarithmic = false) {
  ImGui::PushID(label);
  ImGui::PushItemWidth(110.0F);
  bool changed = ImGui::SliderScalar("##slider", ImGuiDataType_Double, &value, &low, &high, "",
                                     logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  ImGui::PopItemWidth();
  ImGui::SameLine();
  ImGui::PushItemWidth(76.0F);
  double typed = value;
  if (ImGui::InputDouble(label, &typed, 0.0, 0.0, format)) {
    value = std::clamp(typed, low, high);
    changed = true;
  }
  ImGui::PopItemWidth();
  ImGui::PopID();
  return changed;
}

}  // namespace torsion::engine
