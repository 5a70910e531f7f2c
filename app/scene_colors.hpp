#pragma once

#include <optional>
#include <string>

#include "render/draw_options.hpp"

namespace torsion::engine {

/// What SceneView::colors asks for; nothing where nobody said.
inline std::optional<HeatMap> heat_map_of(const std::string& colors) {
  if (colors == "twist") {
    return HeatMap::kTwist;
  }
  if (colors == "pressure") {
    return HeatMap::kPressure;
  }
  return colors == "material" ? std::optional(HeatMap::kNone) : std::nullopt;
}

}  // namespace torsion::engine
