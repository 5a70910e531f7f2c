#include "app/view/banners.hpp"

#include <fmt/format.h>

#include "app/live/device_words.hpp"
#include "app/view/panel_style.hpp"
#include "systems/contact/region_wrenches.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kAmber = IM_COL32(200, 110, 0, 255);

void banner(const char* id, const std::string& line, float& top, ImU32 color) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2.0F, top), ImGuiCond_Always, ImVec2(0.5F, 0.0F));
  ImGui::SetNextWindowSizeConstraints(ImVec2(120.0F, 0.0F), ImVec2(560.0F, 400.0F));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, color);
  ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 255, 255, 255));
  if (ImGui::Begin(id, nullptr,
                   kFixed | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoInputs)) {
    ImGui::PushTextWrapPos(540.0F);
    text(line);
    ImGui::PopTextWrapPos();
    top += ImGui::GetWindowSize().y + 6.0F;
  }
  ImGui::End();
  ImGui::PopStyleColor(2);
}

}  // namespace

void draw_banners(const ViewState& state, const LiveSession& session, double now) {
  float top = 8.0F;
  const LiveFrame& frame = session.frame();
  const std::uint32_t faults = frame.snapshot.clock.faults;
  if (faults != 0) {
    banner("##fault", "FAULT, no force meanwhile: " + faults_text(faults), top, kRed);
  }
  if (session.device() != nullptr) {
    const bool steps = !frame.paused && frame.slowness == 1;
    const DeviceBanner said = device_banner(*session.device(), steps);
    if (!said.text.empty()) {
      banner("##device", said.text, top, said.failed ? kRed : kAmber);
    }
  }
  if (!state.scene_error.empty()) {
    banner("##scene",
           "The file has changed and cannot be used; the scene before it goes on.\n" +
               state.scene_error,
           top, kRed);
  }
  if (state.opening) {
    banner("##opening", "loading ...", top, IM_COL32(40, 100, 60, 255));
  }
  if (state.missed_lately > 10) {
    banner("##late",
           fmt::format("The physics thread was over 1 ms late {} times in the last second.",
                       state.missed_lately),
           top, kAmber);
  }
  if (const std::string problem = session.recording_problem(); !problem.empty()) {
    banner("##record", problem + "\nThe session goes on without a recording; a restart begins one.",
           top, kRed);
  }
  if (now < state.message_until && !state.wants_screenshot) {
    banner("##message", state.message, top, IM_COL32(40, 100, 60, 255));
  }
}

}  // namespace torsion::engine
