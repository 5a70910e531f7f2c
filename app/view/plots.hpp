#pragma once

#include <span>
#include <string>
#include <vector>

namespace torsion::engine {

/// A curve of a plot: points in order. Where y is not a number, it is interrupted.
struct Curve {
  std::string name;
  std::uint32_t rgba = 0;  // as ImGui's IM_COL32
  std::vector<double> x;
  std::vector<double> y;
  bool wide = false;  // so that it is seen beside one that lies on it
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

/// Draws one plot into the current ImGui window, over its width; under the mouse, what the curves
/// are there.
/// @param height  pixels
/// @return whether the mouse is over it
bool draw_plot(const PlotAxes& axes, std::span<const Curve> curves, float height);

/// The point of a curve that is nearest in x; none where it has no number there.
/// @return its row, or the curve's size
std::size_t nearest_in_x(const Curve& curve, double x);

}  // namespace torsion::engine
