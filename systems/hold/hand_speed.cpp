#include "systems/hold/hand_speed.hpp"

#include <glm/geometric.hpp>

#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {

void measure_speed(HandSpeed& speed, const Pose& measured, double period) {
  constexpr double kMemory = 5e-3;  // s
  if (!finite(measured)) {
    return;
  }
  const double share = 1.0 / (period + kMemory);
  speed.velocity += share * (measured.position - speed.measured.position - speed.velocity * period);
  const double turn = glm::length(turn_between(speed.measured.rotation, measured.rotation));
  speed.turn_speed += share * (turn - speed.turn_speed * period);
  speed.measured = measured;
}

}  // namespace torsion::engine
