#include "systems/hold/handle_side.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/hold/virtual_coupling.hpp"
#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

constexpr double kFarthest = 2.0;   // counts: what is farther is followed at once
constexpr double kPlay = 1.0;       // counts: what is nearer is not
constexpr double kSlowTime = 0.25;  // s: of the way between, twice that of a loose hand

/// The part of a change beyond `free`, for each axis.
glm::dvec3 beyond(const glm::dvec3& change, double free) {
  return change - glm::clamp(change, -free, free);
}

/// The part of a change that is followed within `period`.
glm::dvec3 followed(const glm::dvec3& change, double count, double period) {
  const glm::dvec3 at_once = beyond(change, kFarthest * count);
  const double share = std::min(1.0, period / kSlowTime);
  return at_once + share * beyond(change - at_once, kPlay * count);
}

}  // namespace

Pose follow_counts(const Pose& last, const Pose& measured, double count, double turn_count,
                   double period) {
  Pose pose = measured;
  if (count > 0.0) {
    pose.position = last.position + followed(measured.position - last.position, count, period);
  }
  if (turn_count > 0.0) {
    const glm::dvec3 turn =
        followed(turn_between(last.rotation, measured.rotation), turn_count, period);
    const double angle = glm::length(turn);
    pose.rotation = angle > 0.0
                        ? glm::normalize(glm::angleAxis(angle, turn / angle) * last.rotation)
                        : last.rotation;
  }
  return pose;
}

namespace {

constexpr double kSlowest = 1e-9;  // m or rad a sample: slower, damping would divide by nothing
// Used where a device's own are not known: a small handle alone, 50 g with a radius of 20 mm. The
// mechanism and the fingers only add to it, and with more mass a late damper may do more.
constexpr double kLightMass = 0.05;     // kg
constexpr double kLightInertia = 1e-5;  // kg m^2

/// @param held  force on the hand over the past interval
/// @param way   of the handle over it
/// @return the force to display over the next one
glm::dvec3 keep_channel_passive(EnergyBooks& books, const glm::dvec3& held, const glm::dvec3& way,
                                const glm::dvec3& wanted, double largest_damping,
                                double largest_stored, double period) {
  // The force on the hand does the work held . way on it.
  books.stored = std::min(books.stored - glm::dot(held, way), largest_stored);
  const double square = glm::dot(way, way);
  if (books.stored >= 0.0 || square < kSlowest * kSlowest) {
    return wanted;
  }
  // A damper of b takes b v^2 T = b way^2 / T over the next interval, should the hand go on.
  const double damping = std::min(-books.stored * period / square, largest_damping);
  books.dissipated += damping * square / period;
  return wanted - damping * way / period;
}

}  // namespace

PassivityLimits choose_passivity(const DeviceTraits& device) {
  constexpr double kShareOfForce = 0.02;
  const double lag = device.period + 2.0 * device.delay;
  const auto damping = [&](double inertia, double largest, double count) {
    const double most = 0.5 * inertia / lag;
    return count > 0.0 ? std::min(most, kShareOfForce * largest * device.period / count) : most;
  };
  PassivityLimits limits;
  limits.largest_damping = damping(device.mass > 0.0 ? device.mass : kLightMass,
                                   device.largest_force, device.encoder_step);
  limits.largest_turn_damping = damping(device.inertia > 0.0 ? device.inertia : kLightInertia,
                                        device.largest_torque, device.encoder_turn_step);
  limits.delay = static_cast<std::uint32_t>(
      std::clamp(std::round(device.delay / device.period), 0.0, 1.0 * kLongestDelay));
  return limits;
}

Wrench keep_passive(PassivityState& state, const PassivityLimits& limits, const Wrench& wanted,
                    const glm::dvec3& shift, const glm::dvec3& turn, double period) {
  const auto count = static_cast<std::uint32_t>(state.sent.size());
  const Wrench& held =
      state.sent[(state.samples + count - 1 - std::min(limits.delay, kLongestDelay)) % count];
  const Wrench next{
      keep_channel_passive(state.translation, held.force, shift, wanted.force,
                           limits.largest_damping, limits.largest_stored, period),
      keep_channel_passive(state.rotation, held.torque, turn, wanted.torque,
                           limits.largest_turn_damping, limits.largest_stored, period)};
  state.sent[state.samples % count] = next;
  state.samples = (state.samples + 1) % count;
  return next;
}

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
    // What was sent last decreases, from its whole size: it includes its share already.
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

namespace {

constexpr double kNearHandle = 0.01;      // m: a hand finds that without a guide
constexpr double kRiseTime = 0.01;        // s: from nothing to the largest force, at the fastest
constexpr double kUsualPeriod = 1e-3;     // s
constexpr double kLongestPeriod = 20e-3;  // s: a gap, not a period

void begin_epoch(HandleSide& side, const DeviceSample& sample, const Pose& tool) {
  side.epoch = sample.epoch;
  side.coupling = choose_coupling(sample.traits).coupling;
  side.books = {};
  side.guard = {};
  side.limits.largest_force = side.coupling.largest_force;
  side.limits.largest_torque = side.coupling.largest_torque;
  side.limits.largest_force_rate = side.coupling.largest_force / kRiseTime;
  side.limits.largest_torque_rate = side.coupling.largest_torque / kRiseTime;
  side.limits.near = kNearHandle;
  side.map.origin = sample.steers_rate ? tool.position - sample.pose.position : side.home.position;
}

/// Until it takes hold, the handle has the tool's orientation, however it is held.
void wait_for_hold(HandleSide& side, const DeviceSample& sample, const Pose& tool) {
  side.device = sample.pose;
  side.map.turned = sample.pose.rotation;
  side.map.rotation = tool.rotation;
  if (sample.steers_rate) {
    side.map.origin = tool.position - sample.pose.position;
  }
  side.books = {};
  side.last = handle_pose(side.map, side.device);
}

}  // namespace

Pose handle_pose(const HandleMap& map, const Pose& device) {
  return {map.origin + device.position,
          glm::normalize(device.rotation * glm::conjugate(map.turned) * map.rotation)};
}

HandleOutcome take_handle_sample(HandleSide& side, const DeviceSample& sample,
                                 const PhysicsResult& result, double now) {
  HandleOutcome outcome;
  const Pose tool = result.any ? result.tool : side.home;
  const bool live = sample.state == DeviceState::kLive;
  const bool begins = live && sample.epoch != side.epoch;
  if (begins) {
    begin_epoch(side, sample, tool);
  }
  side.passivity = choose_passivity(sample.traits);  // the rate is measured all the time
  const bool waits = live && side.guard.state == GuardState::kWaiting;
  const double period =
      waits ? kUsualPeriod : std::clamp(now - side.last_time, 1e-5, kLongestPeriod);
  if (waits) {
    wait_for_hold(side, sample, tool);
  } else if (live) {
    side.device = follow_counts(side.device, sample.pose, sample.traits.encoder_step,
                                sample.traits.encoder_turn_step, period);
  }
  outcome.handle = live ? handle_pose(side.map, side.device) : side.last;
  GuardInput input;
  input.wanted =
      keep_passive(side.books, side.passivity,
                   felt_wrench(side.hold, side.coupling, outcome.handle, tool, result.contact),
                   outcome.handle.position - side.last.position,
                   turn_between(side.last.rotation, outcome.handle.rotation), period);
  input.result_age = result.any ? now - result.time : 1.0;
  input.faulty = !live || result.faulty;
  outcome.distance = glm::length(outcome.handle.position - tool.position);
  input.distance = outcome.distance;
  outcome.wrench = guard_output(side.guard, side.limits, input, period);
  if (sample.state == DeviceState::kAbsent) {  // nothing displays what falls
    side.guard = {};
    outcome.wrench = {};
  }
  outcome.holds = live && side.guard.state != GuardState::kWaiting;
  side.last = outcome.handle;
  side.last_time = now;
  return outcome;
}

}  // namespace torsion::engine
