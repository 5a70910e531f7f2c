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
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  const double size = round_up(std::max({high, -low, axes.least_y}));
  return {axes.y_from_zero || low > -0.02 * size ? 0.0 : -size,
          high < 0.02 * size && low < 0.0 ? 0.02 * size : size};
}

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
  return {low < -0.02 * size ? -size : 0.0, high > 0.02 * size ? size : 0.02 * size};
}

void draw_curves(ImDrawList& list, const ImVec2& corner, const ImVec2& size, const Span& x_span,
                 const Span& y_span, std::span<const Curve> curves) {
  static std::vector<ImVec2> points;  // kept so that a frame takes no memory
  for (const Curve& curve : curves) {
    points.clear();
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const auto x = static_cast<float>(x_span.share(curve.x[i]));
      const auto y = static_cast<float>(y_span.share(curve.y[i]));
      const ImVec2 point(corner.x + x * size.x, corner.y + (1.0F - y) * size.y);
      // No more points than pixels.
      if (points.empty() || std::abs(point.x - points.back().x) >= 0.5F ||
          std::abs(point.y - points.back().y) >= 0.5F) {
        points.push_back(point);
      }
    }
    list.AddPolyline(points.data(), static_cast<int>(points.size()), curve.rgba, 0, 1.6F);
  }
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

void draw_plot(const PlotAxes& axes, std::span<const Curve> curves, float height) {
  const Span y_span = span_of(curves, axes);
  const Span x_span = x_span_of(curves, axes);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::TextUnformatted(axes.title);
  for (const Curve& curve : curves) {
    if (*curve.name != '\0') {
      ImGui::SameLine();
      ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(curve.rgba), "%s", curve.name);
    }
  }
  constexpr float kLeft = 58.0F;  // pixels: for the numbers
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 corner(at.x + kLeft, at.y);
  const ImVec2 size(ImGui::GetContentRegionAvail().x - kLeft, height);
  draw_frame(list, corner, size, y_span);
  list.PushClipRect(corner, ImVec2(corner.x + size.x, corner.y + size.y), true);
  draw_curves(list, corner, size, x_span, y_span, curves);
  list.PopClipRect();
  const auto write = [&](float x, float y, const std::string& text) {
    list.AddText(ImVec2(x, y), kText, text.c_str());
  };
  write(at.x, corner.y - 2.0F, fmt::format("{:.5g}", y_span.high));
  write(at.x, corner.y + size.y - line, fmt::format("{:.5g}", y_span.low));
  write(corner.x, corner.y + size.y + 1.0F, fmt::format("{:.5g}", x_span.low));
  const std::string right = fmt::format("{:.5g} {}", x_span.high, axes.x_title);
  write(corner.x + size.x - ImGui::CalcTextSize(right.c_str()).x, corner.y + size.y + 1.0F, right);
  ImGui::Dummy(ImVec2(size.x, size.y + line + 4.0F));
}

}  // namespace torsion::engine
