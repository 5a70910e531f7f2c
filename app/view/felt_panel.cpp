#include "app/view/felt_panel.hpp"

#include <array>
#include <numbers>

#include <imgui.h>

#include "app/view/panel_style.hpp"
#include "app/view/plots.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kCurveGreen = IM_COL32(30, 140, 60, 255);
constexpr ImU32 kCurveBlue = IM_COL32(39, 111, 196, 255);
constexpr ImU32 kCurveGrey = IM_COL32(165, 168, 175, 255);
constexpr double kPlotSeconds = 10.0;

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
  const std::array<ImU32, 3> colors = {kRed, kCurveGreen, kCurveBlue};
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
  Curve before{"before the switch", kCurveGrey, {}, {}};
  Curve current{"", kCurveBlue, {}, {}};
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
  draw_plot({"Torque about the normal (N m) by turn", "deg", 0.0, 0.0, 1e-4}, curves, 110.0F);
}

void timing_plot(const History& history) {
  const std::array<Curve, 2> curves = {
      over_time(history, "late", kRed, [](const PlotPoint& point) { return point.late_us; }),
      over_time(history, "step", kCurveBlue, [](const PlotPoint& point) { return point.step_us; })};
  draw_plot({"Physics thread (us)", "s", -kPlotSeconds, 0.0, 50.0, true}, curves, 60.0F);
}

void device_plot(const History& history) {
  const std::array<Curve, 1> curve = {over_time(
      history, "samples", kCurveBlue, [](const PlotPoint& point) { return point.device_hz; })};
  draw_plot({"Device (Hz)", "s", -kPlotSeconds, 0.0, 100.0, true}, curve, 40.0F);
}

}  // namespace

void draw_felt_panel(ViewState& state, LiveSession& session) {
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

}  // namespace torsion::engine
