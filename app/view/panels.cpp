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
#include "app/view/panel_style.hpp"
#include "app/view/plots.hpp"
#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kGreen = IM_COL32(30, 140, 60, 255);
constexpr ImU32 kBlue = IM_COL32(39, 111, 196, 255);
constexpr ImU32 kGrey = IM_COL32(165, 168, 175, 255);
constexpr double kPlotSeconds = 10.0;

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

void state_lines(const ViewState& state, const LiveSession& session) {
  const LiveFrame& frame = session.frame();
  const RunStatistics& statistics = frame.statistics;
  const Clock& clock = frame.snapshot.clock;
  const Wrench& wrench = frame.snapshot.tools.at<ToolWrench>(state.tool).total;
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kBlue), "force %.3g N",
                     glm::length(wrench.force));
  ImGui::SameLine();
  ImGui::TextColored(ImVec4(0.80F, 0.45F, 0.0F, 1.0F), "  torque %.3g N m",
                     glm::length(wrench.torque));
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
  dim("Space pause   N step   R restart");
  dim("S speed   M switch models   Esc close");
  dim("P screenshot   V video   O recording");
}

void left_panel(ViewState& state, LiveSession& session) {
  // From top to bottom, as the one on the right: what panels hide so is not drawn.
  ImGui::SetNextWindowPos(ImVec2(0.0F, 0.0F));
  ImGui::SetNextWindowSize(ImVec2(326.0F, ImGui::GetIO().DisplaySize.y));
  const std::string title =
      std::filesystem::path(session.scene().path).filename().string() + "###session";
  if (ImGui::Begin(title.c_str(), nullptr, kFixed)) {
    state_lines(state, session);
    ImGui::Separator();
    controls(state);
    ImGui::PushItemWidth(170.0F);
    if (ImGui::CollapsingHeader("Model and material", ImGuiTreeNodeFlags_DefaultOpen)) {
      material(state, session);
    }
    if (ImGui::CollapsingHeader("Shown", ImGuiTreeNodeFlags_DefaultOpen)) {
      shown_things(state);
    }
    if (ImGui::CollapsingHeader("Keys", ImGuiTreeNodeFlags_DefaultOpen)) {
      keys();
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
}

/// Curves of what `value` takes from a point, over the last seconds.
template <class F>
Curve over_time(const History& history, const char* name, ImU32 color, F&& value) {
  Curve curve{name, color, {}, {}};
  const double end = history.size() == 0 ? 0.0 : history[history.size() - 1].time;
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history[i].time > end - kPlotSeconds) {
      curve.x.push_back(history[i].time - end);
      curve.y.push_back(value(history[i]));
    }
  }
  return curve;
}

void wrench_plots(const ViewState& state, const History& history) {
  const auto part = [&](int axis, bool torque) {
    return [&state, axis, torque](const PlotPoint& point) {
      const Wrench& wrench = state.contact_axes ? point.contact : point.world;
      return (torque ? wrench.torque : wrench.force)[axis];
    };
  };
  const std::array<const char*, 3> names =
      state.contact_axes ? std::array{"x", "y", "normal"} : std::array{"x", "y", "z"};
  const std::array<ImU32, 3> colors = {kRed, kGreen, kBlue};
  for (const bool torque : {false, true}) {
    std::array<Curve, 3> curves;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      curves[i] = over_time(history, names[i], colors[i], part(axis, torque));
    }
    draw_plot(
        {torque ? "Torque (N m)" : "Force (N)", "s", -kPlotSeconds, 0.0, torque ? 1e-4 : 1e-3},
        curves, 78.0F);
  }
}

/// Torque against the tool's turn: what runs now, and in grey what ran before the last switch.
void turn_plot(const History& history) {
  if (history.size() == 0) {
    return;
  }
  const std::uint64_t now = history[history.size() - 1].generation;
  Curve before{"before the switch", kGrey, {}, {}};
  Curve current{"", kBlue, {}, {}};
  for (std::size_t i = 0; i < history.size(); ++i) {
    const PlotPoint& point = history[i];
    if (point.generation + 1 < now || (point.turn == 0.0 && point.couple == 0.0)) {
      continue;
    }
    Curve& curve = point.generation == now ? current : before;
    curve.x.push_back(point.turn * 180.0 / std::numbers::pi);
    curve.y.push_back(point.couple);
  }
  if (before.x.empty()) {
    before.name = "";
  }
  const std::array<Curve, 2> curves = {before, current};
  draw_plot({"Torque about the normal (N m) by turn of the tool", "deg", 0.0, 0.0, 1e-4}, curves,
            110.0F);
}

void timing_plot(const History& history) {
  const std::array<Curve, 2> curves = {
      over_time(history, "late", kRed, [](const PlotPoint& point) { return point.late_us; }),
      over_time(history, "step", kBlue, [](const PlotPoint& point) { return point.step_us; })};
  draw_plot({"Physics thread (us)", "s", -kPlotSeconds, 0.0, 50.0, true}, curves, 60.0F);
}

void device_plot(const History& history) {
  const std::array<Curve, 1> curve = {
      over_time(history, "samples", kBlue, [](const PlotPoint& point) { return point.device_hz; })};
  draw_plot({"Device (Hz)", "s", -kPlotSeconds, 0.0, 100.0, true}, curve, 40.0F);
}

void right_panel(ViewState& state, LiveSession& session) {
  const float width = 330.0F;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(display.x - width, 0.0F));
  ImGui::SetNextWindowSize(ImVec2(width, display.y));
  if (ImGui::Begin("What is felt", nullptr, kFixed)) {
    const std::vector<ToolDescription>& tools = session.scene().tools;
    if (tools.size() > 1 && ImGui::BeginCombo("tool", tools[state.tool].node.c_str())) {
      for (std::uint32_t i = 0; i < tools.size(); ++i) {
        if (ImGui::Selectable(tools[i].node.c_str(), i == state.tool)) {
          state.tool = i;
        }
      }
      ImGui::EndCombo();
    }
    int axes = state.contact_axes ? 0 : 1;
    ImGui::RadioButton("contact axes", &axes, 0);
    ImGui::SameLine();
    ImGui::RadioButton("world axes", &axes, 1);
    state.contact_axes = axes == 0;
    const History& history = state.histories[state.tool];
    wrench_plots(state, history);
    turn_plot(history);
    timing_plot(history);
    if (session.on_device(state.tool)) {
      device_plot(history);
    }
  }
  ImGui::End();
}

/// What the mouse does now, below the scene.
void mouse_line(const ViewState& state, bool on_device) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2.0F, size.y), ImGuiCond_Always, ImVec2(0.5F, 1.0F));
  if (ImGui::Begin("##mouse", nullptr,
                   kFixed | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoInputs)) {
    if (state.grabbed) {
      text("You hold the tool: move = across   Shift = push along the view");
      text("Alt or wheel = turn it about the contact's normal");
    } else {
      text(on_device ? "The device holds the tool."
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
  right_panel(state, session);
  mouse_line(state, session.on_device(state.tool));
}

}  // namespace torsion::engine
