#pragma once

#include <cstdint>

#include "ecs/device_sample.hpp"

namespace torsion::engine {

/// Buttons that turn the tool about its turn axis, for a device that senses no turn.
struct TurnButtons {
  std::uint32_t left = 1U << 0;   // bits of DeviceSample::buttons: counter-clockwise while held
  std::uint32_t right = 1U << 3;  // clockwise
  double speed = 1.0;             // rad/s
};

/// How far they have turned it.
struct ButtonTurn {
  double angle = 0.0;  // rad
  double time = 0.0;   // s: until when
};

/// Where nothing senses a turn, two buttons of a device make one, at a constant speed: the sample's
/// rotation is theirs then.
/// @param axis  world, at rest: what the tool turns about
void turn_by_buttons(ButtonTurn& turn, const TurnButtons& by, const glm::dvec3& axis,
                     DeviceSample& sample, double now);

}  // namespace torsion::engine
