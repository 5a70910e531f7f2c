#pragma once

#include <string>

#include "render/draw_options.hpp"

namespace torsion::engine {

/// What the numbers beside a colour bar are.
struct HeatScale {
  double low = 0.0;  // in the unit of the title
  double high = 0.0;
  std::string title;          // with the unit
  bool square_roots = false;  // on both sides of the middle; else linear

  /// @param share  place on the bar, 0 to 1
  [[nodiscard]] double value_at(double share) const;
};

/// The scale in the unit that its numbers read best in.
/// @param limit  rad or Pa, as in DrawOptions
HeatScale heat_scale(HeatMap map, double limit);

}  // namespace torsion::engine
