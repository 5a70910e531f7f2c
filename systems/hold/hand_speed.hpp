#pragma once

#include "ecs/components.hpp"

namespace torsion::engine {

/// How fast a device's handle moves, smoothed over a few samples: one count in one short period is
/// no speed.
struct HandSpeed {
  Pose measured;             // in the sample before
  glm::dvec3 velocity{0.0};  // m/s
  double turn_speed = 0.0;   // rad/s
};

/// One sample. One that is not finite changes nothing: no force comes of it either.
/// @param period  s, since the sample before
void measure_speed(HandSpeed& speed, const Pose& measured, double period);

}  // namespace torsion::engine
