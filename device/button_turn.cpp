#include "device/button_turn.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace torsion::engine {

void turn_by_buttons(ButtonTurn& turn, const TurnButtons& by, const glm::dvec3& axis,
                     DeviceSample& sample, double now) {
  constexpr double kLongestStep = 20e-3;  // s: a button counts no longer between two samples
  const double elapsed = std::clamp(now - turn.time, 0.0, kLongestStep);
  turn.time = now;
  sample.buttons_turn = sample.sensed == kTranslationAxes;
  if (!sample.buttons_turn) {
    return;
  }
  const double left = (sample.buttons & by.left) != 0 ? 1.0 : 0.0;
  const double right = (sample.buttons & by.right) != 0 ? 1.0 : 0.0;
  turn.angle =
      std::remainder(turn.angle + (left - right) * by.speed * elapsed, 2.0 * std::numbers::pi);
  sample.pose.rotation = glm::angleAxis(turn.angle, axis);
}

}  // namespace torsion::engine
