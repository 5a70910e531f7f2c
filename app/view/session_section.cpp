#include "app/view/session_section.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "app/live/device_words.hpp"
#include "app/view/panel_style.hpp"

namespace torsion::engine {
namespace {

/// The device that holds the tool, and in red what of the contact it does not let one feel.
void device_part(const DeviceView& device) {
  ImGui::PushTextWrapPos();
  for (const std::string& line : device_lines(device)) {
    text(line);
  }
  ImGui::PopTextWrapPos();
  if (const std::string missing = not_displayed(device); !missing.empty()) {
    ImGui::PushTextWrapPos();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kRed), "%s", missing.c_str());
    ImGui::PopTextWrapPos();
  }
}

/// What a card shows of itself under the mouse.
void card_words(const GalleryEntry& entry, const AtlasPicture& picture) {
  ImGui::BeginTooltip();
  if (picture.width > 0.0F) {
    ImGui::Image(ImGui::GetIO().Fonts->TexID, ImVec2(picture.width, picture.height),
                 ImVec2(picture.u0, picture.v0), ImVec2(picture.u1, picture.v1));
  }
  ImGui::PushTextWrapPos(static_cast<float>(kCardWidth) + 10.0F);
  text(entry.title);
  dim(entry.caption);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// One scene: its picture and the key that opens it. @return whether it was clicked
bool card(const ViewState& state, std::size_t i) {
  const ImVec2 size(kCardWidth / 3.0F, kCardHeight / 3.0F);
  const AtlasPicture& picture = state.cards[i].small;
  const bool clicked = ImGui::InvisibleButton(fmt::format("card {}", i).c_str(), size);
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(ImGui::GetIO().Fonts->TexID, low, high, ImVec2(picture.u0, picture.v0),
                ImVec2(picture.u1, picture.v1));
  if (state.entry == i || ImGui::IsItemHovered()) {
    list.AddRect(low, high, kForceInk, 0.0F, 0, state.entry == i ? 3.0F : 1.5F);
  }
  if (i < 9) {
    const std::string key = fmt::format("{}", i + 1);
    list.AddRectFilled(low, ImVec2(low.x + 14.0F, low.y + 17.0F), IM_COL32(255, 255, 255, 235));
    list.AddText(ImVec2(low.x + 3.0F, low.y + 1.0F), IM_COL32(30, 32, 36, 255), key.c_str());
  }
  if (ImGui::IsItemHovered()) {
    card_words(state.gallery[i], state.cards[i].large);
  }
  return clicked;
}

/// A force or torque in words. What is less than a ten-thousandth of `scale` is noise beside it.
std::string in_words(double value, double scale) {
  constexpr double kNoise = 1e-4;
  return value < std::max(kNoise * scale, 1e-12) ? "0" : fmt::format("{:.3g}", value);
}

/// What moves the tool, if no device does.
std::string who_holds(const ViewState& state, const LiveSession& session) {
  const VirtualCoupling& coupling = session.coupling(state.tool);
  if (!session.held(state.tool)) {
    return "moved by the scene's animation";
  }
  if (state.let_go) {
    return "let go of: no force";
  }
  if (session.way() == ToolHold::kDirect) {
    return "held by the mouse, directly";
  }
  return fmt::format("held by the mouse: {:.3g} N/m, up to {:.3g} N", coupling.stiffness,
                     coupling.largest_force);
}

/// One scene without a picture. @return whether it was clicked
bool line(const ViewState& state, std::size_t i) {
  const GalleryEntry& entry = state.gallery[i];
  const std::string words =
      i < 9 ? fmt::format("{}  {}", i + 1, entry.title) : fmt::format("    {}", entry.title);
  const bool clicked = ImGui::Selectable(words.c_str(), state.entry == i);
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s", entry.caption.c_str());
  }
  return clicked;
}

}  // namespace

void draw_gallery_cards(ViewState& state) {
  constexpr std::size_t kColumns = 4;
  constexpr std::size_t kAtFirst = 11;  // three rows, with a button for the others
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(4.0F, 4.0F));
  const auto all = static_cast<std::size_t>(std::ranges::count_if(
      state.cards, [](const CardPictures& card) { return card.small.width > 0.0F; }));
  const bool folded = !state.all_cards && all > kAtFirst + 1;
  std::size_t cards = 0;
  for (std::size_t i = 0; i < state.gallery.size(); ++i) {
    if (state.cards[i].small.width == 0.0F) {
      continue;
    }
    if (cards++ % kColumns != 0) {
      ImGui::SameLine();
    }
    if (folded && cards > kAtFirst) {
      const ImVec2 size(kCardWidth / 3.0F, kCardHeight / 3.0F);
      state.all_cards = ImGui::Button(fmt::format("{} more", all - kAtFirst).c_str(), size);
      break;
    }
    if (card(state, i)) {
      state.wants_entry = i;
    }
  }
  ImGui::PopStyleVar();
  for (std::size_t i = 0; i < state.gallery.size(); ++i) {
    if (state.cards[i].small.width == 0.0F && line(state, i)) {
      state.wants_entry = i;
    }
  }
}

void draw_state_lines(const ViewState& state, const LiveSession& session) {
  const LiveFrame& frame = session.frame();
  const Clock& clock = frame.snapshot.clock;
  const Wrench& wrench = frame.snapshot.tools.at<ToolWrench>(state.tool).total;
  const History& history = state.histories[state.tool];
  const PlotPoint last = history.size() > 0 ? history[history.size() - 1] : PlotPoint{};
  const double moment = last.normal_force * last.radius;
  text_in(kForceInk, fmt::format("force {} N", in_words(glm::length(wrench.force), 0.0)));
  ImGui::SameLine();
  text_in(kTorqueInk, fmt::format("  torque {} N m", in_words(glm::length(wrench.torque), moment)));
  text(fmt::format("normal {} N, friction {} N", in_words(last.normal_force, 0.0),
                   in_words(last.friction_force, last.normal_force)));
  text(fmt::format("couple {} N m, r x F {} N m", in_words(last.couples, moment),
                   in_words(last.arm_torque, moment)));
  if (session.on_device(state.tool)) {
    device_part(*session.device());
  } else {
    text(who_holds(state, session));
  }
  dim(fmt::format("time {:.3f} s, {} contact region{}", clock.time, frame.snapshot.regions.size(),
                  frame.snapshot.regions.size() == 1 ? "" : "s"));
}

namespace {

/// A button that says its key under the mouse.
bool key_button(const char* label, const char* key) {
  const bool clicked = ImGui::Button(label);
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Key: %s", key);
  }
  ImGui::SameLine();
  return clicked;
}

void choose_speed(ViewState& state) {
  const auto name = [](std::uint32_t slowness) {
    return slowness == 1 ? std::string("speed 1") : fmt::format("speed 1/{}", slowness);
  };
  ImGui::PushItemWidth(-1.0F);
  if (ImGui::BeginCombo("##speed", name(state.slowness).c_str())) {
    for (const std::uint32_t slowness : {1U, 5U, 20U, 100U}) {
      if (ImGui::Selectable(name(slowness).c_str(), state.slowness == slowness)) {
        state.slowness = slowness;
      }
    }
    ImGui::EndCombo();
  }
  ImGui::PopItemWidth();
}

}  // namespace

void draw_controls(ViewState& state) {
  if (key_button(state.paused ? "Go on##pause" : "Pause##pause", "Space")) {
    state.paused = !state.paused;
  }
  state.wants_step = key_button("Step", "N") || state.wants_step;
  state.wants_restart = key_button("Restart", "R") || state.wants_restart;
  choose_speed(state);
  state.wants_screenshot = key_button("Picture", "P") || state.wants_screenshot;
  state.wants_video = key_button("Video", "V") || state.wants_video;
  state.wants_saved_recording = key_button("Recording", "O") || state.wants_saved_recording;
  ImGui::Checkbox("Loop", &state.loop);
}

}  // namespace torsion::engine
