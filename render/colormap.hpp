#pragma once

#include <glm/vec3.hpp>

#include "render/draw_options.hpp"

namespace torsion::engine {

/// The colour of a heat map at `at`, 0 to 1 along its scale (clamped): sRGB-encoded, 0 to 1. The
/// body's colour and the colour bar both come from here. Twist has a pale middle, for zero, and
/// darkens evenly to blue (negative) and red (positive); pressure darkens evenly from pale, for
/// zero, over yellow and red to violet. kNone is pale throughout.
glm::dvec3 heat_color(HeatMap map, double at);

}  // namespace torsion::engine
