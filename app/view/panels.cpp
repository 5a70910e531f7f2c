#include "app/view/panels.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>

#include "app/view/banners.hpp"
#include "app/view/felt_section.hpp"
#include "app/view/panel_layout.hpp"
#include "app/view/panel_style.hpp"
#include "app/view/session_section.hpp"
#include "app/view/settings_section.hpp"

namespace torsion::engine {
namespace {

constexpr ImGuiWindowFlags kPanel = kFixed | ImGuiWindowFlags_NoTitleBar;

/// A button of the folded panel. The signs are of the font that Gui loads.
bool icon(const char* sign, const char* meaning) {
  const bool clicked = ImGui::Button(sign, ImVec2(28.0F, 28.0F));
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s", meaning);
  }
  return clicked;
}

void draw_icons(ViewState& state) {
  if (icon("\u2630", "Open the panel")) {
    state.folded = false;
  }
  if (icon(state.paused ? "\u25B6" : "\u2016", "Pause or go on (Space)")) {
    state.paused = !state.paused;
  }
  state.wants_restart = icon("\u21BB", "From the start (R)") || state.wants_restart;
  if (icon("S", "Slow motion (S)")) {
    state.slowness = next_slowness(state.slowness);
  }
  state.wants_screenshot = icon("P", "Picture (P)") || state.wants_screenshot;
  state.wants_video = icon("V", "Video (V)") || state.wants_video;
  state.wants_release = icon("G", "Let go of the tool (G)") || state.wants_release;
  state.wants_view = icon("C", "The camera as at first (C)") || state.wants_view;
}

void draw_sections(ViewState& state, LiveSession& session) {
  if (ImGui::SmallButton("\u00AB")) {
    state.folded = true;
  }
  ImGui::SameLine();
  const SceneDescription& scene = session.scene();
  text(scene.view.title.empty() ? std::filesystem::path(scene.path).filename().string()
                                : scene.view.title);
  if (!state.gallery.empty() &&
      ImGui::CollapsingHeader(
          "Gallery", state.entry ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None)) {
    draw_gallery_cards(state);
  }
  draw_state_lines(state, session);
  ImGui::Separator();
  draw_controls(state);
  if (ImGui::CollapsingHeader("What is felt", ImGuiTreeNodeFlags_DefaultOpen)) {
    draw_felt(state, session);
  } else {
    state.over_plot = false;
  }
  draw_settings(state, session);
}

/// From top to bottom: what it hides is not drawn.
void draw_panel(ViewState& state, LiveSession& session) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float width = covered_columns(state, display.x, display.y);
  const bool icons = folded(state, display.x, display.y);
  ImGui::SetNextWindowPos(ImVec2(0.0F, 0.0F));
  ImGui::SetNextWindowSize(ImVec2(width, display.y));
  // The wheel over a plot is the plot's.
  const ImGuiWindowFlags wheel =
      state.over_plot ? ImGuiWindowFlags_NoScrollWithMouse : ImGuiWindowFlags_None;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, icons ? ImVec2(6.0F, 6.0F) : ImVec2(8.0F, 6.0F));
  if (ImGui::Begin(icons ? "##icons" : "##panel", nullptr, kPanel | wheel)) {
    if (icons) {
      draw_icons(state);
    } else {
      draw_sections(state, session);
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

/// What to look at, and what the mouse does now, below the scene.
void mouse_line(const ViewState& state, const LiveSession& session) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float left = covered_columns(state, size.x, size.y);
  ImGui::SetNextWindowPos(ImVec2(0.5F * (left + size.x), size.y), ImGuiCond_Always,
                          ImVec2(0.5F, 1.0F));
  if (ImGui::Begin("##mouse", nullptr,
                   kFixed | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoInputs)) {
    if (const std::string& caption = session.scene().view.caption; !caption.empty()) {
      ImGui::PushTextWrapPos(std::min(590.0F, size.x - left - 60.0F));
      text(caption);
      ImGui::PopTextWrapPos();
      ImGui::Separator();
    }
    if (state.grabbed) {
      text(state.free_drag ? "You hold the tool: move = across   Shift = push along the view"
                           : "You hold the tool: move = press and lift   Shift = slide");
      text(session.on_device(state.tool)
               ? "The device turns it"
               : "Ring, wheel or Alt = turn it about the contact's normal");
    } else {
      text(session.carries(state.tool)
               ? "The device turns the tool; carry it with the left mouse button."
           : session.on_device(state.tool) ? "The device holds the tool."
                                           : "Take the tool with the left mouse button and press "
                                             "it on the body; its ring turns it.");
      dim("Elsewhere: left = orbit, right = pan, wheel = zoom");
    }
  }
  ImGui::End();
}

}  // namespace

std::uint32_t next_slowness(std::uint32_t slowness) {
  return slowness == 1 ? 5 : slowness == 5 ? 20 : slowness == 20 ? 100 : 1;
}

bool differ(const std::vector<BodyPick>& a, const std::vector<BodyPick>& b) {
  return !std::ranges::equal(a, b, [](const BodyPick& x, const BodyPick& y) {
    return body_entry(0, 0, x).values == body_entry(0, 0, y).values;
  });
}

void draw_panels(ViewState& state, LiveSession& session, double now) {
  draw_banners(state, session, now);
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  if (covered_columns(state, display.x, display.y) > 0.0F) {
    draw_panel(state, session);
    mouse_line(state, session);
  }
}

}  // namespace torsion::engine
