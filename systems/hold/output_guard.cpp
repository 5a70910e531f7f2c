#include "systems/hold/output_guard.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/math/finite.hpp"

namespace torsion::engine {
namespace {

constexpr double kNothing = 1e-9;  // a share that is only the rounding of what fell

glm::dvec3 at_most(const glm::dvec3& vector, double most) {
  const double length = glm::length(vector);
  return length > most ? vector * (most / length) : vector;
}

/// It goes against a force that it should follow, faster and for longer than anybody would begin to
/// push.
bool runs_away(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
               double period) {
  const bool against = guard.state == GuardState::kRising && !guard.risen &&
                       guard.signs != SignVerdict::kRight &&
                       glm::dot(guard.sent.force, input.velocity) < 0.0 &&
                       glm::length(input.velocity) > limits.largest_unchecked_speed;
  guard.against_for = against ? guard.against_for + period : 0.0;
  return guard.against_for > limits.longest_against;
}

/// What stands against a force.
GuardReason reason_against(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
                           double period) {
  if (!input.live) {
    return GuardReason::kNotLive;
  }
  if (input.faulty || input.result_age > limits.longest_silence || !finite(input.wanted) ||
      !finite(input.probe) || !finite({input.weight, glm::dvec3(0.0)}) ||
      !std::isfinite(input.distance)) {
    return GuardReason::kPhysics;
  }
  if (!input.held) {
    return GuardReason::kLetGo;
  }
  if (guard.state == GuardState::kChecking && input.signs == SignVerdict::kReversed) {
    return GuardReason::kReversed;
  }
  if (runs_away(guard, limits, input, period)) {
    return GuardReason::kRanAway;
  }
  const bool slow = glm::length(input.velocity) <= limits.largest_speed &&
                    input.turn_speed <= limits.largest_turn_speed;
  return slow ? GuardReason::kNone : GuardReason::kTooFast;
}

bool ends_for_good(GuardReason reason) {
  return reason == GuardReason::kReversed || reason == GuardReason::kRanAway;
}

void change_state(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
                  GuardReason against, double period) {
  switch (guard.state) {
    case GuardState::kWaiting:
      guard.share = 0.0;
      if (against != GuardReason::kNone) {
        guard.reason = against;
      } else if (input.distance > limits.near) {
        guard.reason = GuardReason::kFar;
      } else {
        guard.state = guard.checked ? GuardState::kRising : GuardState::kChecking;
      }
      break;
    case GuardState::kChecking:
      if (input.signs != SignVerdict::kRunning) {
        guard.checked = true;
        guard.signs = input.signs;
        guard.state = GuardState::kRising;
      }
      break;
    case GuardState::kRising:
      guard.share =
          std::min(1.0, guard.share + period / (guard.risen ? limits.rise : limits.first_rise));
      guard.state = guard.share == 1.0 ? GuardState::kLive : GuardState::kRising;
      break;
    case GuardState::kLive:
      guard.risen = true;
      break;
    case GuardState::kFalling:
      guard.share -= period / limits.fall;
      guard.share = guard.share > kNothing ? guard.share : 0.0;
      if (guard.share == 0.0) {
        guard.state = ends_for_good(guard.reason) ? GuardState::kOff : GuardState::kWaiting;
      }
      break;
    case GuardState::kOff:
      break;
  }
}

/// What is to be sent, before the limits of size and rate. What carries the device comes and goes
/// with what it displays.
struct WantedOutput {
  Wrench wrench;
  glm::dvec3 carried{0.0};
};

WantedOutput wanted_output(const OutputGuard& guard, const GuardInput& input, bool good) {
  const auto share = [&guard](const Wrench& wrench, const glm::dvec3& carried) {
    return WantedOutput{{guard.share * wrench.force, guard.share * wrench.torque},
                        guard.share * carried};
  };
  switch (guard.state) {
    case GuardState::kChecking:
      return good ? WantedOutput{input.probe} : WantedOutput{};
    case GuardState::kFalling:
      return share(guard.last_good, guard.last_carried);
    case GuardState::kRising:
    case GuardState::kLive:
      return good ? share(input.wanted, input.weight) : WantedOutput{};
    default:
      return {};
  }
}

}  // namespace

Wrench guard_output(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
                    double period) {
  const GuardReason against = reason_against(guard, limits, input, period);
  const bool good = against == GuardReason::kNone;
  const bool sends = guard.state == GuardState::kChecking || guard.state == GuardState::kRising ||
                     guard.state == GuardState::kLive;
  if (!good && sends) {
    // What was sent last decreases, from its whole size: it includes its share already.
    guard.state = GuardState::kFalling;
    guard.reason = against;
    guard.last_good = guard.sent;
    guard.last_carried = guard.carried;
    guard.share = 1.0;
  }
  change_state(guard, limits, input, against, period);
  const WantedOutput wanted = wanted_output(guard, input, good);
  const double allowed = allowed_now(guard.force_heat, limits.largest_force);
  const glm::dvec3 carried = at_most(wanted.carried, allowed);
  const glm::dvec3 force =
      at_most(wanted.wrench.force, std::max(0.0, allowed - glm::length(carried)));
  const glm::dvec3 torque =
      at_most(wanted.wrench.torque, allowed_now(guard.torque_heat, limits.largest_torque));
  // A fall has its own rate, which is safer than any slower one.
  const bool falls = guard.state == GuardState::kFalling || guard.state == GuardState::kWaiting ||
                     guard.state == GuardState::kOff;
  const double force_step = falls ? limits.largest_force : limits.largest_force_rate * period;
  const double torque_step = falls ? limits.largest_torque : limits.largest_torque_rate * period;
  const glm::dvec3 carried_step = at_most(carried - guard.carried, force_step);
  guard.carried += carried_step;
  const double step_left = std::max(0.0, force_step - glm::length(carried_step));
  guard.sent.force += at_most(force - guard.sent.force, step_left);
  guard.sent.torque += at_most(torque - guard.sent.torque, torque_step);
  // While one makes room for the other they are together no more than the limit, either.
  const Wrench whole{at_most(guard.sent.force + guard.carried, limits.largest_force),
                     guard.sent.torque};
  take_loss(guard.force_heat, glm::length(whole.force), period);
  take_loss(guard.torque_heat, glm::length(whole.torque), period);
  return whole;
}

}  // namespace torsion::engine
