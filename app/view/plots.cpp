#include "app/view/plots.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "app/round_up.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kFrame = IM_COL32(120, 126, 135, 255);
constexpr ImU32 kGrid = IM_COL32(222, 225, 230, 255);
constexpr ImU32 kText = IM_COL32(60, 64, 70, 255);
constexpr ImU32 kPaper = IM_COL32(252, 252, 253, 255);

struct Span {
  double low = 0.0;
  double high = 1.0;
  [[nodiscard]] double share(double value) const { return (value - low) / (high - low); }
};

/// The least span of round numbers around all values.
Span span_of(std::span<const Curve> curves, const PlotAxes& axes) {
  double low = 0.0;
  double high = 0.0;
  for (const Curve& curve : curves) {
    for (const double y : curve.y) {
      low = std::isfinite(y) ? std::min(low, y) : low;
      high = std::isfinite(y) ? std::max(high, y) : high;
    }
  }
  const double size = round_up(std::max({high, -low, axes.least_y}));
  const bool below = !axes.y_from_zero && low < -0.02 * size;
  const bool above = high > 0.02 * size;
  return {below ? -size : 0.0, above || !below ? size : 0.0};
}

/// Around all values; from -1 to 1 or 0 to 1 at least.
Span x_span_of(std::span<const Curve> curves, const PlotAxes& axes) {
  if (axes.x_to > axes.x_from) {
    return {axes.x_from, axes.x_to};
  }
  double low = 0.0;
  double high = 0.0;
  for (const Curve& curve : curves) {
    for (const double x : curve.x) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  const double size = round_up(std::max({high, -low, 1.0}));
  const bool left = low < -0.02 * size;
  const bool right = high > 0.02 * size;
  return {left ? -size : 0.0, right || !left ? size : 0.0};
}

/// Where a plot is, and what its sides stand for.
struct Place {
  ImVec2 corner;  // top left
  ImVec2 size;
  Span x;
  Span y;
  [[nodiscard]] ImVec2 of(double x_value, double y_value) const {
    return {corner.x + static_cast<float>(x.share(x_value)) * size.x,
            corner.y + (1.0F - static_cast<float>(y.share(y_value))) * size.y};
  }
};

void draw_curves(ImDrawList& list, const Place& place, std::span<const Curve> curves) {
  static std::vector<ImVec2> points;  // kept so that a frame takes no memory
  for (const Curve& curve : curves) {
    points.clear();
    const auto flush = [&] {
      list.AddPolyline(points.data(), static_cast<int>(points.size()), curve.rgba, 0,
                       curve.wide ? 5.0F : 1.8F);
      points.clear();
    };
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.y[i])) {
        flush();
        continue;
      }
      const ImVec2 point = place.of(curve.x[i], curve.y[i]);
      // No more points than pixels.
      if (points.empty() || std::abs(point.x - points.back().x) >= 0.5F ||
          std::abs(point.y - points.back().y) >= 0.5F) {
        points.push_back(point);
      }
    }
    flush();
  }
}

/// The curve's point that is seen nearest the mouse, within a few pixels.
std::size_t nearest_seen(const Place& place, const Curve& curve, const ImVec2& mouse) {
  constexpr float kNear = 30.0F;
  std::size_t found = curve.x.size();
  float least = kNear;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (std::isfinite(curve.y[i])) {
      const ImVec2 at = place.of(curve.x[i], curve.y[i]);
      const float far = std::hypot(at.x - mouse.x, at.y - mouse.y);
      if (far < least) {
        least = far;
        found = i;
      }
    }
  }
  return found;
}

/// What the curves are under the mouse, beside it, and dots there.
void tell_values(ImDrawList& list, const Place& place, const PlotAxes& axes,
                 std::span<const Curve> curves) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool over_time = axes.x_to > axes.x_from;
  const double x = place.x.low + (place.x.high - place.x.low) *
                                     static_cast<double>((mouse.x - place.corner.x) / place.size.x);
  ImGui::BeginTooltip();
  if (over_time) {
    ImGui::TextUnformatted(fmt::format("{:.3g} {}", x, axes.x_title).c_str());
  }
  const double near = 0.02 * (place.x.high - place.x.low);
  for (const Curve& curve : curves) {
    const std::size_t i = over_time ? nearest_in_x(curve, x) : nearest_seen(place, curve, mouse);
    if (i < curve.x.size() && (!over_time || std::abs(curve.x[i] - x) < near)) {
      list.AddCircleFilled(place.of(curve.x[i], curve.y[i]), 3.0F, curve.rgba);
      const std::string at =
          over_time ? std::string() : fmt::format("{:.3g} {}: ", curve.x[i], axes.x_title);
      ImGui::TextUnformatted(fmt::format("{}{} {:.4g}", at, curve.name, curve.y[i]).c_str());
    }
  }
  ImGui::EndTooltip();
}

void draw_frame(ImDrawList& list, const ImVec2& corner, const ImVec2& size, const Span& y_span) {
  const ImVec2 end(corner.x + size.x, corner.y + size.y);
  list.AddRectFilled(corner, end, kPaper);
  for (const double share : {0.25, 0.5, 0.75}) {
    const float y = corner.y + static_cast<float>(share) * size.y;
    list.AddLine(ImVec2(corner.x, y), ImVec2(end.x, y), kGrid);
  }
  if (y_span.low < 0.0) {
    const float y = corner.y + static_cast<float>(1.0 - y_span.share(0.0)) * size.y;
    list.AddLine(ImVec2(corner.x, y), ImVec2(end.x, y), kFrame);
  }
  list.AddRect(corner, end, kFrame);
}

}  // namespace

std::size_t nearest_in_x(const Curve& curve, double x) {
  if (curve.x.empty()) {
    return 0;
  }
  const auto after = std::ranges::lower_bound(curve.x, x);
  auto i = static_cast<std::size_t>(after - curve.x.begin());
  if (i == curve.x.size() || (i > 0 && x - curve.x[i - 1] < curve.x[i] - x)) {
    --i;
  }
  return std::isfinite(curve.y[i]) ? i : curve.x.size();
}

bool draw_plot(const PlotAxes& axes, std::span<const Curve> curves, float height) {
  constexpr float kLeft = 56.0F;  // pixels: for the numbers
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::TextUnformatted(axes.title);
  for (const Curve& curve : curves) {
    if (!curve.name.empty()) {
      ImGui::SameLine();
      ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(curve.rgba), "%s", curve.name.c_str());
    }
  }
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Place place{ImVec2(at.x + kLeft, at.y),
                    ImVec2(ImGui::GetContentRegionAvail().x - kLeft, height),
                    x_span_of(curves, axes), span_of(curves, axes)};
  const ImVec2& corner = place.corner;
  const ImVec2 end(corner.x + place.size.x, corner.y + height);
  draw_frame(list, corner, place.size, place.y);
  list.PushClipRect(corner, end, true);
  draw_curves(list, place, curves);
  const bool hovered = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(corner, end);
  if (hovered) {
    tell_values(list, place, axes, curves);
  }
  list.PopClipRect();
  const auto write = [&](float x, float y, const std::string& text) {
    list.AddText(ImVec2(x, y), kText, text.c_str());
  };
  write(at.x, corner.y - 2.0F, fmt::format("{:.4g}", place.y.high));
  write(at.x, end.y - line, fmt::format("{:.4g}", place.y.low));
  write(corner.x, end.y + 1.0F, fmt::format("{:.4g}", place.x.low));
  const std::string right = fmt::format("{:.4g} {}", place.x.high, axes.x_title);
  write(end.x - ImGui::CalcTextSize(right.c_str()).x, end.y + 1.0F, right);
  ImGui::Dummy(ImVec2(place.size.x, height + line + 3.0F));
  return hovered;
}

}  // namespace torsion::engine
