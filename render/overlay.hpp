#pragma once

#include <string>
#include <vector>

#include "render/draw_options.hpp"
#include "render/overlay_font.hpp"

namespace torsion::engine {

/// What is written over a picture.
struct OverlayContent {
  std::vector<std::string> lines;  // top left, one under the other
  HeatMap heat_map = HeatMap::kNone;
  double heat_limit = 1.0;   // rad or Pa, as in DrawOptions
  double full_force = 0.0;   // N of the longest arrow; 0: no legend
  double full_torque = 0.0;  // N m of the longest arc; 0: no legend
  double full_couple = 0.0;  // N m likewise, where the couples are apart and arcs of r x F; else 0
  std::string banner;        // a fault, over the whole width; empty: none
};

/// Text height that suits a picture of this height, pixels.
double overlay_text_height(std::uint32_t picture_height);

/// Lays the content out over a picture of width x height pixels.
OverlayDrawList draw_overlay(const OverlayFont& font, const OverlayContent& content,
                             std::uint32_t width, std::uint32_t height);

}  // namespace torsion::engine
