#include "systems/hold/output_guard.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/math/finite.hpp"

namespace torsion {
namespace {

constexpr double kNothing = 1e-9;  // a share that is only the rounding of what fell

glm::dvec3 at_most(const glm::dvec3& vector, double most) {
  const double length = glm::length(vector);
  return length > most ? vector * (most / length) : vector;
}

void change_state(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input, bool good,
                  double period) {
  switch (guard.state) {
    case GuardState::kWaiting:
      guard.share = 0.0;
      if (good && input.distance <= limits.near) {
        guard.state = GuardState::kRising;
      }
      break;
    case GuardState::kRising:
      guard.share = std::min(1.0, guard.share + period / limits.rise);
      guard.state = guard.share == 1.0 ? GuardState::kLive : GuardState::kRising;
      break;
    case GuardState::kLive:
      break;
    case GuardState::kFalling:
      guard.share -= period / limits.fall;
      guard.share = guard.share > kNothing ? guard.share : 0.0;
      guard.state = guard.share == 0.0 ? GuardState::kWaiting : GuardState::kFalling;
      break;
  }
}

}  // namespace

Wrench guard_output(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
                    double period) {
  const bool good = !input.faulty && input.result_age <= limits.longest_silence &&
                    finite(input.wanted) && std::isfinite(input.distance);
  if (!good && (guard.state == GuardState::kLive || guard.state == GuardState::kRising)) {
    // What was sent last falls, from its whole size: its share is already in it.
    guard.state = GuardState::kFalling;
    guard.last_good = guard.sent;
    guard.share = 1.0;
  }
  change_state(guard, limits, input, good, period);
  const bool falling = guard.state == GuardState::kFalling;
  const Wrench source = falling ? guard.last_good : good ? input.wanted : Wrench{};
  const glm::dvec3 force = at_most(guard.share * source.force, limits.largest_force);
  const glm::dvec3 torque = at_most(guard.share * source.torque, limits.largest_torque);
  // A fall has its own rate, which is safer than any slower one.
  const bool ended = guard.state == GuardState::kWaiting;
  const double force_step =
      falling || ended ? limits.largest_force : limits.largest_force_rate * period;
  const double torque_step =
      falling || ended ? limits.largest_torque : limits.largest_torque_rate * period;
  guard.sent.force += at_most(force - guard.sent.force, force_step);
  guard.sent.torque += at_most(torque - guard.sent.torque, torque_step);
  return guard.sent;
}

}  // namespace torsion
