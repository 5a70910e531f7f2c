#include "render/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "render/colormap.hpp"
#include "render/heat_scale.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t rgba(std::uint32_t r, std::uint32_t g, std::uint32_t b, std::uint32_t a) {
  return r | g << 8U | b << 16U | a << 24U;
}

constexpr std::uint32_t kPanel = rgba(255, 255, 255, 205);
constexpr std::uint32_t kInk = rgba(25, 28, 33, 255);
constexpr std::uint32_t kFault = rgba(190, 20, 20, 235);
constexpr std::uint32_t kWhite = rgba(255, 255, 255, 255);
// As render/arrows.cpp draws them, sRGB.
constexpr std::uint32_t kForceText = rgba(39, 111, 196, 255);
constexpr std::uint32_t kTorqueText = rgba(225, 129, 0, 255);
constexpr std::uint32_t kCoupleText = rgba(149, 48, 173, 255);

std::uint32_t color_of(const glm::dvec3& color) {
  const auto byte = [](double value) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  };
  return rgba(byte(color.x), byte(color.y), byte(color.z), 255);
}

std::string number(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value == 0.0 ? 0.0 : value);
  return text.data();
}

/// A panel as wide as its lines, with its bottom left or top left corner near the picture's.
void append_lines(const OverlayFont& font, const std::vector<std::string>& lines, double x,
                  double y, OverlayDrawList& list) {
  double width = 0.0;
  for (const std::string& line : lines) {
    width = std::max(width, font.width_of(line));
  }
  const double line_height = font.line_height();
  const double pad = 0.4 * line_height;
  font.append_box(list, x, y, x + width + 2.0 * pad,
                  y + line_height * static_cast<double>(lines.size()) + 2.0 * pad, kPanel);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    font.append_text(list, lines[i], x + pad, y + pad + line_height * static_cast<double>(i), kInk);
  }
}

void append_color_bar(const OverlayFont& font, const OverlayContent& content, double right,
                      double bottom, OverlayDrawList& list) {
  constexpr int kSteps = 128;
  constexpr int kTicks = 4;  // intervals
  const HeatScale scale = heat_scale(content.heat_map, content.heat_limit);
  const double line = font.line_height();
  const double pad = 0.4 * line;
  const double bar_width = 12.0 * line;
  const double panel_width = bar_width + 4.0 * line;
  const double left = right - panel_width;
  const double top = bottom - 3.2 * line - 2.0 * pad;
  font.append_box(list, left, top, right, bottom, kPanel);
  font.append_text(list, scale.title, left + 0.5 * (panel_width - font.width_of(scale.title)),
                   top + pad, kInk);
  const double bar_left = left + 2.0 * line;
  const double bar_top = top + pad + 1.15 * line;
  const double bar_bottom = bar_top + 0.8 * line;
  for (int i = 0; i < kSteps; ++i) {
    const double at = (i + 0.5) / kSteps;
    font.append_box(list, bar_left + bar_width * i / kSteps, bar_top,
                    bar_left + bar_width * (i + 1) / kSteps, bar_bottom,
                    color_of(heat_color(content.heat_map, at)));
  }
  for (int i = 0; i <= kTicks; ++i) {
    const double share = static_cast<double>(i) / kTicks;
    const double x = bar_left + bar_width * share;
    font.append_box(list, x - 0.5, bar_bottom, x + 0.5, bar_bottom + 0.2 * line, kInk);
    const std::string text = number(scale.value_at(share));
    font.append_text(list, text, x - 0.5 * font.width_of(text), bar_bottom + 0.2 * line, kInk);
  }
}

void append_legend(const OverlayFont& font, const OverlayContent& content, double left,
                   double bottom, OverlayDrawList& list) {
  const double line = font.line_height();
  const double pad = 0.4 * line;
  const bool parts = content.full_couple > 0.0;
  const std::string force = "force, full arrow " + number(content.full_force) + " N";
  const std::string torque = std::string(parts ? "r x F" : "torque") + ", full arc " +
                             number(content.full_torque) + " N m";
  const std::string couple = "couple, full arc " + number(content.full_couple) + " N m";
  const double couple_width = parts ? font.width_of(couple) : 0.0;
  const double width =
      std::max({font.width_of(force), font.width_of(torque), couple_width}) + 1.6 * line;
  const double top = bottom - (parts ? 3.0 : 2.0) * line - 2.0 * pad;
  font.append_box(list, left, top, left + width + 2.0 * pad, bottom, kPanel);
  const auto row = [&](const std::string& text, std::uint32_t color, double y) {
    font.append_box(list, left + pad, y + 0.35 * line, left + pad + 1.1 * line, y + 0.7 * line,
                    color);
    font.append_text(list, text, left + pad + 1.6 * line, y, kInk);
  };
  row(force, kForceText, top + pad);
  row(torque, kTorqueText, top + pad + line);
  if (parts) {
    row(couple, kCoupleText, top + pad + 2.0 * line);
  }
}

}  // namespace

double overlay_text_height(std::uint32_t picture_height) {
  return std::clamp(static_cast<double>(picture_height) / 32.0, 11.0, 64.0);
}

OverlayDrawList draw_overlay(const OverlayFont& font, const OverlayContent& content,
                             std::uint32_t width, std::uint32_t height) {
  OverlayDrawList list;
  const double margin = 0.6 * font.line_height();
  const auto right = static_cast<double>(width) - margin;
  const auto bottom = static_cast<double>(height) - margin;
  if (!content.lines.empty()) {
    append_lines(font, content.lines, margin, margin, list);
  }
  if (content.heat_map != HeatMap::kNone) {
    append_color_bar(font, content, right, bottom, list);
  }
  if (content.full_force > 0.0 || content.full_torque > 0.0) {
    append_legend(font, content, margin, bottom, list);
  }
  if (!content.banner.empty()) {
    const double top = 0.5 * (static_cast<double>(height) - 2.0 * font.line_height());
    font.append_box(list, 0.0, top, static_cast<double>(width), top + 2.0 * font.line_height(),
                    kFault);
    font.append_text(list, content.banner,
                     0.5 * (static_cast<double>(width) - font.width_of(content.banner)),
                     top + 0.5 * font.line_height(), kWhite);
  }
  return list;
}

}  // namespace torsion::engine
