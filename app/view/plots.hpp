#pragma once

#include <span>
#include <string>
#include <vector>

namespace torsion::engine {

/// A curve of a plot: points in order.
struct Curve {
  const char* name = "";
  std::uint32_t rgba = 0;  // as ImGui's IM_COL32
  std::vector<double> x;
  std::vector<double> y;
};

/// How a plot's axes are laid out.
struct PlotAxes {
  const char* title = "";    // with the unit of y
  const char* x_title = "";  // with its unit
  double x_from = 0.0;
  double x_to = 0.0;       // equal: as wide as the curves
  double least_y = 1e-12;  // the y axis spans at least this, so that noise looks small
  bool y_from_zero = false;
};

/// Draws one plot into the current ImGui window, over its width.
/// @param height  pixels
void draw_plot(const PlotAxes& axes, std::span<const Curve> curves, float height);

}  // namespace torsion::engine
