#pragma once

// What the files that build panels share.

#include <string>

#include <imgui.h>

namespace torsion::engine {

inline constexpr ImU32 kRed = IM_COL32(200, 45, 45, 255);
// A panel that appears takes no focus: a button that is held down would lose its click.
inline constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing;

inline void text(const std::string& line) {
  ImGui::TextUnformatted(line.c_str());
}

}  // namespace torsion::engine
