#include "app/view/panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "app/live/device_words.hpp"
#include "app/view/banners.hpp"
#include "app/view/felt_panel.hpp"
#include "app/view/panel_style.hpp"
#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kBlue = IM_COL32(39, 111, 196, 255);

void dim(const std::string& line) {
  ImGui::TextDisabled("%s", line.c_str());
}

/// Which body and model, in one row of combos.
template <class Model, std::size_t N>
void model_combo(const char* label, const std::array<std::string_view, N>& names, Model& model) {
  if (ImGui::BeginCombo(label, names[static_cast<std::size_t>(model)].data())) {
    for (std::size_t i = 0; i < N; ++i) {
      if (ImGui::Selectable(names[i].data(), static_cast<std::size_t>(model) == i)) {
        model = static_cast<Model>(i);
      }
    }
    ImGui::EndCombo();
  }
}

bool slider(const char* label, double& value, double low, double high, const char* format,
            bool logarithmic = false) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format,
                             logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
}

void controls(ViewState& state) {
  if (ImGui::Button(state.paused ? "Go on (Space)" : "Pause (Space)")) {
    state.paused = !state.paused;
  }
  ImGui::SameLine();
  if (ImGui::Button("Step (N)")) {
    state.wants_step = true;
  }
  ImGui::SameLine();
  if (ImGui::Button("Restart (R)")) {
    state.wants_restart = true;
  }
  if (ImGui::Button("Screenshot (P)")) {
    state.wants_screenshot = true;
  }
  ImGui::SameLine();
  if (ImGui::Button(state.filming ? "End video (V)" : "Video (V)")) {
    state.wants_video = true;
  }
  ImGui::SameLine();
  if (ImGui::Button("Recording (O)")) {
    state.wants_saved_recording = true;
  }
  ImGui::Checkbox("Loop (L)", &state.loop);
  text("Speed (S)");
  for (const std::uint32_t slowness : {1U, 5U, 20U, 100U}) {
    ImGui::SameLine();
    const std::string name = slowness == 1 ? "1" : fmt::format("1/{}", slowness);
    if (ImGui::RadioButton(name.c_str(), state.slowness == slowness)) {
      state.slowness = slowness;
    }
  }
}

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

/// The scenes that ship, one click or key each.
void gallery_list(ViewState& state) {
  for (std::size_t i = 0; i < state.gallery.size(); ++i) {
    const std::string line = i < 9 ? fmt::format("{}  {}", i + 1, state.gallery[i].title)
                                   : fmt::format("    {}", state.gallery[i].title);
    if (ImGui::Selectable(line.c_str(), state.entry == i)) {
      state.wants_entry = i;
    }
  }
}

/// N or N m: below a billionth there is nothing but rounding.
std::string shown(double value) {
  return value < 1e-9 ? "0" : fmt::format("{:.3g}", value);
}

void state_lines(const ViewState& state, const LiveSession& session) {
  const LiveFrame& frame = session.frame();
  const Clock& clock = frame.snapshot.clock;
  const Wrench& wrench = frame.snapshot.tools.at<ToolWrench>(state.tool).total;
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kBlue), "force %.3g N",
                     glm::length(wrench.force));
  ImGui::SameLine();
  ImGui::TextColored(ImVec4(0.80F, 0.45F, 0.0F, 1.0F), "  torque %.3g N m",
                     glm::length(wrench.torque));
  const History& history = state.histories[state.tool];
  const PlotPoint last = history.size() > 0 ? history[history.size() - 1] : PlotPoint{};
  text(fmt::format("normal {} N, friction {} N", shown(last.normal_force),
                   shown(last.friction_force)));
  text(fmt::format("couple {} N m, r x F {} N m", shown(last.couples), shown(last.arm_torque)));
  const VirtualCoupling& coupling = session.coupling(state.tool);
  if (session.on_device(state.tool)) {
    device_part(*session.device());
  } else if (session.held(state.tool)) {
    ImGui::PushTextWrapPos();
    text(session.way() == ToolHold::kDirect
             ? "held by the mouse, directly"
             : fmt::format("held by the mouse: {:.3g} N/m, up to {:.3g} N{}", coupling.stiffness,
                           coupling.largest_force,
                           session.way() == ToolHold::kMass ? ", with its mass" : ""));
    ImGui::PopTextWrapPos();
  } else {
    text("moved by the scene's animation");
  }
  dim(fmt::format("time {:.3f} s, {} contact region{}", clock.time, frame.snapshot.regions.size(),
                  frame.snapshot.regions.size() == 1 ? "" : "s"));
}

/// How the physics thread and the pictures keep up.
void timing_lines(const ViewState& state, const LiveSession& session) {
  const RunStatistics& statistics = session.frame().statistics;
  dim(fmt::format("step {:.0f} us, 99 % {:.0f} us; late 99 % {:.0f} us",
                  statistics.step_times.quantile(0.5), statistics.step_times.quantile(0.99),
                  statistics.lateness.quantile(0.99)));
  dim(fmt::format("over 1 ms late: {} of {}", statistics.missed_deadlines,
                  statistics.lateness.count()));
  dim(fmt::format("{:.0f} pictures a second at {:.0f} % size", state.frames_per_second,
                  100.0 * state.share));
  ImGui::PushTextWrapPos();
  dim("physics thread: " + describe(session.mode()));
  ImGui::PopTextWrapPos();
}

/// A motion by numbers.
void tool_move(ViewState& state, const LiveSession& session) {
  constexpr double kMillimeter = 1e-3;
  constexpr double kDegree = std::numbers::pi / 180.0;
  const auto number = [](const char* label, double& value, double unit, double step) {
    constexpr double kMost = 1e4;  // 1e999 can be typed, and no handle is there
    double typed = value / unit;
    if (ImGui::InputDouble(label, &typed, step, 10.0 * step, "%.3g")) {
      value = unit * std::clamp(typed, -kMost, kMost);
    }
  };
  number("press (mm)", state.move.press, kMillimeter, 1.0);
  number("turn (deg)", state.move.turn, kDegree, 5.0);
  number("slide (mm)", state.move.slide, kMillimeter, 1.0);
  number("in (s)", state.move.seconds, 1.0, 0.5);
  state.move.seconds = std::clamp(state.move.seconds, 0.05, 1000.0);
  if (session.on_device(state.tool)) {
    dim("The device holds the tool.");
  } else if (state.moving) {
    text("moving ...");
  } else if (ImGui::Button("Go")) {
    state.wants_move = true;
  }
  int free = state.free_drag ? 1 : 0;
  text("Mouse (F)");
  ImGui::SameLine();
  ImGui::RadioButton("press, turn", &free, 0);
  ImGui::SameLine();
  ImGui::RadioButton("free", &free, 1);
  state.free_drag = free == 1;
}

void material(ViewState& state, LiveSession& session) {
  if (state.picks.empty()) {
    return;
  }
  if (state.picks.size() > 1 &&
      ImGui::BeginCombo("body", session.scene().bodies[state.body].node.c_str())) {
    for (std::uint32_t i = 0; i < state.picks.size(); ++i) {
      if (ImGui::Selectable(session.scene().bodies[i].node.c_str(), i == state.body)) {
        state.body = i;
      }
    }
    ImGui::EndCombo();
  }
  BodyPick& pick = state.picks[state.body];
  model_combo("contact model", kContactModelNames, pick.contact);
  model_combo("body model", kBodyModelNames, pick.body);
  slider("E (Pa)", pick.elasticity.youngs_modulus, 1e3, 1e9, "%.3g", true);
  slider("nu", pick.elasticity.poisson_ratio, 0.0, 0.5, "%.3f");
  if (slider("friction", pick.friction.static_friction, 0.0, 2.0, "%.2f")) {
    pick.friction.dynamic_friction =
        std::min(pick.friction.dynamic_friction, pick.friction.static_friction);
  }
  slider("sliding", pick.friction.dynamic_friction, 0.0, pick.friction.static_friction, "%.2f");
  if (session.preparing()) {
    text("preparing ...");
  } else if (!differ(state.picks, session.shown().picks)) {
    dim("running as chosen");
  } else if (ImGui::Button("Switch while running (M)")) {
    state.wants_choice = true;
  }
  const ModelChoice& choice = session.shown().simulation.choices[state.body];
  dim(fmt::format("runs: {}, {}", name_of(choice.models.contact), name_of(choice.models.body)));
  if (!session.preparation_error().empty()) {
    ImGui::PushTextWrapPos();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kRed), "%s",
                       session.preparation_error().c_str());
    ImGui::PopTextWrapPos();
  }
}

void shown_things(ViewState& state) {
  int map = static_cast<int>(state.draw.heat_map);
  ImGui::RadioButton("material", &map, 0);
  ImGui::SameLine();
  ImGui::RadioButton("twist", &map, 1);
  ImGui::SameLine();
  ImGui::RadioButton("pressure", &map, 2);
  state.draw.heat_map = static_cast<HeatMap>(map);
  ImGui::Checkbox("regions", &state.show_regions);
  ImGui::SameLine();
  ImGui::Checkbox("stick / slip", &state.show_cells);
  ImGui::SameLine();
  ImGui::Checkbox("arrows", &state.draw.arrows);
  ImGui::Checkbox("anchors", &state.show_anchors);
  ImGui::SameLine();
  ImGui::Checkbox("fixed", &state.show_fixed);
  ImGui::SameLine();
  ImGui::Checkbox("grid", &state.draw.grid);
  ImGui::SameLine();
  ImGui::Checkbox("glass tool", &state.draw.transparent_tools);
}

void keys() {
  dim("G let go of the tool    H hide panels");
  dim("Space pause   N step   R restart   L loop");
  dim("S speed   M switch models   Esc close");
  dim("P screenshot   V video   O recording");
  dim("F free mouse   C camera as at first");
}

void left_panel(ViewState& state, LiveSession& session) {
  // From top to bottom, as the one on the right: what panels hide so is not drawn.
  ImGui::SetNextWindowPos(ImVec2(0.0F, 0.0F));
  ImGui::SetNextWindowSize(ImVec2(326.0F, ImGui::GetIO().DisplaySize.y));
  const std::string title =
      std::filesystem::path(session.scene().path).filename().string() + "###session";
  if (ImGui::Begin(title.c_str(), nullptr, kFixed)) {
    const auto open_if = [](bool open) {
      return open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None;
    };
    if (!state.gallery.empty() &&
        ImGui::CollapsingHeader("Gallery", open_if(state.entry.has_value()))) {
      gallery_list(state);
    }
    state_lines(state, session);
    ImGui::Separator();
    controls(state);
    ImGui::PushItemWidth(170.0F);
    if (ImGui::CollapsingHeader("Model and material", open_if(!state.entry))) {
      material(state, session);
    }
    if (ImGui::CollapsingHeader("Move the tool")) {
      tool_move(state, session);
    }
    if (ImGui::CollapsingHeader("Shown", ImGuiTreeNodeFlags_DefaultOpen)) {
      shown_things(state);
    }
    if (ImGui::CollapsingHeader("Keys", ImGuiTreeNodeFlags_DefaultOpen)) {
      keys();
    }
    if (ImGui::CollapsingHeader("Timing")) {
      timing_lines(state, session);
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
}

/// What to look at, and what the mouse does now, below the scene.
void mouse_line(const ViewState& state, const LiveSession& session) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2.0F, size.y), ImGuiCond_Always, ImVec2(0.5F, 1.0F));
  if (ImGui::Begin("##mouse", nullptr,
                   kFixed | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoInputs)) {
    if (const std::string& caption = session.scene().view.caption; !caption.empty()) {
      ImGui::PushTextWrapPos(590.0F);
      text(caption);
      ImGui::PopTextWrapPos();
      ImGui::Separator();
    }
    if (state.grabbed) {
      text(state.free_drag ? "You hold the tool: move = across   Shift = push along the view"
                           : "You hold the tool: move = press and lift   Shift = slide");
      text("Alt or wheel = turn it about the contact's normal");
    } else {
      text(session.on_device(state.tool)
               ? "The device holds the tool."
               : "Take the tool with the left mouse button and press it on the body.");
      dim("Elsewhere: left = orbit, right = pan, wheel = zoom");
    }
  }
  ImGui::End();
}

}  // namespace

bool differ(const std::vector<BodyPick>& a, const std::vector<BodyPick>& b) {
  return !std::ranges::equal(a, b, [](const BodyPick& x, const BodyPick& y) {
    return body_entry(0, 0, x).values == body_entry(0, 0, y).values;
  });
}

void draw_panels(ViewState& state, LiveSession& session, double now) {
  draw_banners(state, session, now);
  if (!state.show_panels) {
    return;
  }
  left_panel(state, session);
  draw_felt_panel(state, session);
  mouse_line(state, session);
}

}  // namespace torsion::engine
