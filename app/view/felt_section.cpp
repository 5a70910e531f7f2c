#include "app/view/felt_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "app/view/exact_curves.hpp"
#include "app/view/panel_style.hpp"
#include "app/view/plots.hpp"
#include "render/arrows.hpp"

namespace torsion::engine {
namespace {

constexpr double kInterrupted = std::numeric_limits<double>::quiet_NaN();
constexpr float kTimePlot = 44.0F;  // pixels, of their height
constexpr float kTurnPlot = 78.0F;
constexpr float kTimingPlot = 44.0F;

/// Curves of what `value` takes from a point, over the last seconds.
template <class F>
Curve over_time(const History& history, double seconds, const char* name, ImU32 color, F&& value) {
  Curve curve{name, color, {}, {}, false};
  const double end = history.size() == 0 ? 0.0 : history[history.size() - 1].time;
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history[i].time > end - seconds) {
      curve.x.push_back(history[i].time - end);
      curve.y.push_back(value(history[i]));
    }
  }
  return curve;
}

/// N m: how far the axis of a plot goes at least, as the arcs do.
double least_torque(const History& history) {
  double least = 1e-9;
  for (std::size_t i = 0; i < history.size(); ++i) {
    least = std::max(least,
                     kLeastTorqueShare * glm::length(history[i].world.force) * history[i].radius);
  }
  return least;
}

bool wrench_plots(const ViewState& state, const History& history) {
  const auto part = [&](int axis, bool torque) {
    return [&state, axis, torque](const PlotPoint& point) {
      const Wrench& wrench = state.contact_axes ? point.contact : point.world;
      return (torque ? wrench.torque : wrench.force)[axis];
    };
  };
  const std::array<const char*, 3> names =
      state.contact_axes ? std::array{"x", "y", "normal"} : std::array{"x", "y", "z"};
  const std::array<ImU32, 3> colors = {kMiddleCurve, kLightCurve, kDarkCurve};
  bool hovered = false;
  for (const bool torque : {false, true}) {
    std::array<Curve, 3> curves;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      curves[i] = over_time(history, state.plot_seconds, names[i], colors[i], part(axis, torque));
    }
    hovered = draw_plot({torque ? "Torque (N m)" : "Force (N)", "s", -state.plot_seconds, 0.0,
                         torque ? least_torque(history) : 1e-3},
                        curves, kTimePlot) ||
              hovered;
  }
  return hovered;
}

/// A shade for each region, dark to light, in the order in which they formed.
ImU32 shade(std::size_t row, std::size_t rows) {
  const double at = rows > 1 ? static_cast<double>(row) / static_cast<double>(rows - 1) : 0.0;
  const auto mix = [at](int from, int to) {
    return from + static_cast<int>(at * (to - from));
  };
  return IM_COL32(mix(20, 120), mix(40, 205), mix(110, 235), 255);
}

/// The couple of each of several regions, by the number that is written at its ring.
bool region_plot(const ViewState& state, const RegionHistory& history, double least) {
  const RegionHistory::Moment& now = history[history.size() - 1];
  std::vector<Curve> curves;
  for (std::size_t row = 0; row < now.count; ++row) {
    const std::uint64_t order = now.regions[row].order;
    Curve curve{fmt::format("{}", order + 1), shade(row, now.count), {}, {}, false};
    for (std::size_t i = 0; i < history.size(); ++i) {
      const RegionHistory::Moment& moment = history[i];
      if (moment.time > now.time - state.plot_seconds) {
        const auto found = std::ranges::find(moment.span(), order, &RegionPoint::order);
        curve.x.push_back(moment.time - now.time);
        curve.y.push_back(found == moment.span().end() ? kInterrupted : found->couple);
      }
    }
    curves.push_back(std::move(curve));
  }
  return draw_plot({"Couples (N m)", "s", -state.plot_seconds, 0.0, least}, curves, kTimePlot);
}

/// Each region in a line.
void region_lines(const RegionHistory::Moment& now) {
  for (std::size_t row = 0; row < now.count; ++row) {
    const RegionPoint& region = now.regions[row];
    text_in(shade(row, now.count), fmt::format("{}", region.order + 1));
    ImGui::SameLine();
    text(fmt::format("{:.3g} N, {:.3g} N m, sticks {:.0f} %", region.normal_force, region.couple,
                     100.0 * region.stick_share));
  }
}

/// Couple against the tool's turn, of the points of one generation. A contact that ends takes its
/// curve with it.
Curve over_turn(const History& history, std::uint64_t generation, const std::string& name,
                ImU32 color) {
  Curve curve{name, color, {}, {}, false};
  std::uint64_t contact = 0;
  for (std::size_t i = 0; i < history.size(); ++i) {
    const PlotPoint& point = history[i];
    if (point.generation == generation) {
      const bool goes_on = point.region != 0 && point.region == contact;
      curve.x.push_back(point.turn * 180.0 / std::numbers::pi);
      curve.y.push_back(goes_on ? point.couple : kInterrupted);
      contact = point.region;
    }
  }
  return curve;
}

/// What runs now; of the other tools, in lighter colours; and in grey what ran before the last
/// switch.
void turn_plot(const ViewState& state, const LiveSession& session) {
  const History& history = state.histories[state.tool];
  if (history.size() == 0) {
    return;
  }
  const std::uint64_t now = history[history.size() - 1].generation;
  const std::vector<ToolDescription>& tools = session.scene().tools;
  const auto name_of_tool = [&](std::uint32_t tool) {
    return tools.size() > 1 ? tools[tool].node : std::string();
  };
  std::vector<Curve> curves;
  if (now > 0) {
    Curve before = over_turn(history, now - 1, "before the switch", kGreyCurve);
    if (!before.x.empty()) {
      curves.push_back(std::move(before));
    }
  }
  double least = least_torque(history);
  for (std::uint32_t tool = 0; tool < tools.size(); ++tool) {
    if (tool != state.tool) {
      constexpr std::array kOthers = {kMiddleCurve, kLightCurve};
      curves.push_back(over_turn(state.histories[tool], now, name_of_tool(tool),
                                 kOthers[curves.size() % kOthers.size()]));
      least = std::max(least, least_torque(state.histories[tool]));
    }
  }
  const auto exact =
      exact_contact(session.scene(), session.shown().simulation.world.model, state.tool);
  if (exact) {
    Curve curve = exact_over_turn(history, now, *exact);
    if (!curve.x.empty()) {
      curves.push_back(std::move(curve));
    }
  }
  curves.push_back(over_turn(history, now, name_of_tool(state.tool), kDarkCurve));
  draw_plot({"Couple (N m) by turn", "deg", 0.0, 0.0, least}, curves, kTurnPlot);
}

/// How fast the tool slides, on a way round, and spins: each by itself, so that force and couple go
/// along their limit.
void speed_knobs(ViewState& state, const LiveSession& session) {
  constexpr double kMillimeter = 1e-3;
  constexpr double kFastest = 20.0;       // mm/s
  constexpr double kFastestSpin = 720.0;  // degrees a second
  constexpr double kDegree = std::numbers::pi / 180.0;
  constexpr float kKnobWidth = 142.0F;  // pixels: two beside each other
  if (session.on_device(state.tool)) {
    return;
  }
  const auto knob = [](const char* name, double& value, double unit, double low, double high,
                       const char* format) {
    double shown = value / unit;
    ImGui::PushItemWidth(kKnobWidth);
    if (ImGui::SliderScalar(name, ImGuiDataType_Double, &shown, &low, &high, format)) {
      value = unit * std::clamp(shown, low, high);  // more can be typed
    }
    ImGui::PopItemWidth();
  };
  knob("##slide", state.speeds.slide, kMillimeter, 0.0, kFastest, "slide %.1f mm/s");
  ImGui::SameLine();
  knob("##spin", state.speeds.spin, kDegree, -kFastestSpin, kFastestSpin, "spin %.0f deg/s");
}

/// Couple against friction force, where both are there, with the limit of a contact that slips as a
/// whole.
void limit_plot(ViewState& state, const LiveSession& session) {
  constexpr double kSlides = 0.05;  // of mu F
  const History& history = state.histories[state.tool];
  const auto exact =
      exact_contact(session.scene(), session.shown().simulation.world.model, state.tool);
  if (!exact || history.size() == 0) {
    return;
  }
  const PlotPoint& now = history[history.size() - 1];
  const double limit = exact->friction * now.normal_force;
  Curve path{"", kDarkCurve, {}, {}, false};
  bool slides = false;
  bool spins = false;
  for (std::size_t i = 0; i < history.size(); ++i) {
    const PlotPoint& point = history[i];
    if (now.region != 0 && point.region == now.region && point.generation == now.generation) {
      path.x.push_back(point.friction_force);
      path.y.push_back(std::abs(point.couple));
      slides = slides || point.friction_force > kSlides * limit;
      spins = spins || std::abs(point.couple) > kSlides * limit * point.radius;
    }
  }
  if (slides && spins) {
    const std::array<Curve, 2> curves = {exact_limit(now.normal_force, *exact), std::move(path)};
    draw_plot({"Couple (N m) by friction", "N", 0.0, 0.0, least_torque(history), true}, curves,
              kTurnPlot);
  }
  if ((slides && spins) || state.speeds.any()) {
    speed_knobs(state, session);
  }
}

void choose_tool(ViewState& state, const LiveSession& session) {
  const std::vector<ToolDescription>& tools = session.scene().tools;
  if (tools.size() > 1 && ImGui::BeginCombo("tool", tools[state.tool].node.c_str())) {
    for (std::uint32_t i = 0; i < tools.size(); ++i) {
      if (ImGui::Selectable(tools[i].node.c_str(), i == state.tool)) {
        state.tool = i;
      }
    }
    ImGui::EndCombo();
  }
}

/// The wheel over a plot of time: longer or shorter.
void zoom_time(ViewState& state, bool hovered) {
  constexpr double kNotch = 0.8;
  constexpr double kShortest = 0.25;  // s
  constexpr double kLongest = History::kPeriod * static_cast<double>(History::kPoints);
  state.over_plot = hovered;
  if (const float wheel = ImGui::GetIO().MouseWheel; hovered && wheel != 0.0F) {
    state.plot_seconds = std::clamp(
        state.plot_seconds * std::pow(kNotch, static_cast<double>(wheel)), kShortest, kLongest);
  }
}

}  // namespace

void draw_felt(ViewState& state, const LiveSession& session) {
  choose_tool(state, session);
  int axes = state.contact_axes ? 0 : 1;
  ImGui::RadioButton("contact axes", &axes, 0);
  ImGui::SameLine();
  ImGui::RadioButton("world axes", &axes, 1);
  state.contact_axes = axes == 0;
  const History& history = state.histories[state.tool];
  bool hovered = wrench_plots(state, history);
  limit_plot(state, session);
  turn_plot(state, session);
  const RegionHistory& regions = state.region_histories[state.tool];
  if (regions.size() > 0 && regions[regions.size() - 1].count > 1) {
    hovered = region_plot(state, regions, least_torque(history)) || hovered;
    region_lines(regions[regions.size() - 1]);
  }
  zoom_time(state, hovered);
}

void draw_timing_plots(ViewState& state, const LiveSession& session) {
  const History& history = state.histories[state.tool];
  const double seconds = state.plot_seconds;
  const std::array<Curve, 2> curves = {
      over_time(history, seconds, "late", kMiddleCurve,
                [](const PlotPoint& point) { return point.late_us; }),
      over_time(history, seconds, "step", kDarkCurve,
                [](const PlotPoint& point) { return point.step_us; })};
  draw_plot({"Physics thread (us)", "s", -seconds, 0.0, 50.0, true}, curves, kTimingPlot);
  if (session.on_device(state.tool)) {
    const std::array<Curve, 1> curve = {
        over_time(history, seconds, "samples", kDarkCurve,
                  [](const PlotPoint& point) { return point.device_hz; })};
    draw_plot({"Device (Hz)", "s", -seconds, 0.0, 100.0, true}, curve, kTimingPlot);
  }
}

}  // namespace torsion::engine
