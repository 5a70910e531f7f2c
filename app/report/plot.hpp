#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace torsion::engine {

/// One set of points of a plot.
struct PlotSeries {
  enum class Style { kLine, kPoints, kLineWithPoints, kSteps };
  std::string label;  // in the legend; empty: none
  Style style = Style::kLine;
  std::string color = "#000000";
  int dash = 1;   // gnuplot's number: 1 is solid
  int point = 7;  // gnuplot's number: 7 is a filled circle
  double width = 1.6;
  std::vector<glm::dvec2> points;
  std::vector<std::string> point_labels;  // beside the points; empty: none
};

struct Plot {
  std::string caption;  // below the plot
  std::string x_label;  // with its unit
  std::string y_label;
  bool logarithmic = false;  // both axes
  bool from_zero = false;    // y starts at 0
  std::vector<PlotSeries> series;
};

}  // namespace torsion::engine
