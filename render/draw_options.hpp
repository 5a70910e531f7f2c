#pragma once

#include <cstdint>

namespace torsion::engine {

/// What the body's colour shows.
enum class HeatMap : std::uint32_t {
  kNone,      // the material's own colour
  kTwist,     // twist angle, summed over the regions, signed; the scale goes from -heat_limit to
              // +heat_limit, rad, by square roots, because a twist falls off with the third
              // power of the distance
  kPressure,  // normal contact pressure; the scale goes from 0 to heat_limit, Pa
};

/// How tools are drawn.
enum class ToolLook : std::uint8_t {
  kAuthored,  // as their materials say: opaque, or glass where the alpha mode is BLEND
  kGlass,     // so that every contact shows through
  kOpaque,
};

/// What one picture shows.
struct DrawOptions {
  HeatMap heat_map = HeatMap::kNone;
  double heat_limit = 1.0;  // rad or Pa at the end of the colour scale, > 0
  bool grid = true;    // material lines, fixed to the body at rest, and marks that turn with a tool
  bool ground = true;  // a floor under the bodies that takes the shadow
  ToolLook tools = ToolLook::kAuthored;
  bool arrows = true;         // force and torque on each tool
  bool torque_parts = false;  // contact couples apart from what the forces' arms make
  double full_force = 0.0;    // N that the longest arrow stands for; 0: the largest drawn so far
  double full_torque = 0.0;   // N m that the longest arc stands for; 0: the largest drawn so far
  double full_couple = 0.0;   // N m: likewise, of the couples apart
};

}  // namespace torsion::engine
