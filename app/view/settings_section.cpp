#include "app/view/settings_section.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>
#include <imgui.h>

#include "app/view/felt_section.hpp"
#include "app/view/panel_style.hpp"
#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

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

/// Tools as glass, as opaque, or as the scene has them.
void tool_look_box(ToolLook& look) {
  constexpr std::array<const char*, 3> kLooks = {"as authored", "glass", "opaque"};
  int chosen = static_cast<int>(look);
  ImGui::PushItemWidth(110.0F);
  if (ImGui::Combo("tool##look", &chosen, kLooks.data(), static_cast<int>(kLooks.size()))) {
    look = static_cast<ToolLook>(chosen);
  }
  ImGui::PopItemWidth();
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
  if (slider("hand (N)", state.strength, 0.1, 1000.0, "%.3g", true)) {
    state.wants_strength = true;
  }
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
  tool_look_box(state.draw.tools);
  ImGui::Checkbox("legend", &state.show_legend);
  ImGui::SameLine();
  ImGui::Checkbox("couples apart from r x F", &state.draw.torque_parts);
}

void keys() {
  dim("G let go of the tool    H hide the panel");
  dim("Space pause   N step   R restart   L loop");
  dim("S speed   M switch models   Esc close");
  dim("P picture   V video   O recording");
  dim("F free mouse   C camera as at first");
}

}  // namespace

void draw_settings(ViewState& state, LiveSession& session) {
  ImGui::PushItemWidth(170.0F);
  if (ImGui::CollapsingHeader("Model and material")) {
    material(state, session);
  }
  if (ImGui::CollapsingHeader("Move the tool")) {
    tool_move(state, session);
  }
  if (ImGui::CollapsingHeader("Shown")) {
    shown_things(state);
  }
  if (ImGui::CollapsingHeader("Keys")) {
    keys();
  }
  if (ImGui::CollapsingHeader("Timing")) {
    timing_lines(state, session);
    draw_timing_plots(state, session);
  }
  ImGui::PopItemWidth();
}

}  // namespace torsion::engine
