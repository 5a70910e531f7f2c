#include "systems/hold/handle_side.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/hold/count_play.hpp"
#include "systems/hold/virtual_coupling.hpp"
#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

constexpr double kNearHandle = 0.01;      // m: a hand finds that without a guide
constexpr double kRiseTime = 0.01;        // s: from nothing to the largest force, at the fastest
constexpr double kShareOfCheck = 0.05;    // of the largest force: may see whether it goes right
constexpr double kMostOfWeight = 0.5;     // of it: is left to carry the device itself
constexpr double kUsualPeriod = 1e-3;     // s
constexpr double kShortestPeriod = 1e-5;  // s
constexpr double kLongestPeriod = 20e-3;  // s: a gap, not a period
constexpr double kGapPeriods = 2.5;       // of a slow device

/// As stiff as the device is able to display, by what is known of it now.
void choose_springs(HandleSide& side, const DeviceTraits& traits) {
  side.coupling = choose_coupling(traits).coupling;
  side.couplings += 1;
}

double first_known(double said, double known) {
  return said > 0.0 ? said : known;
}

/// Its poses say how far it has been moved, not where it is.
bool has_no_place(const DeviceSample& sample) {
  return sample.steers_rate || (sample.sensed & kTranslationAxes) == 0;
}

void begin_epoch(HandleSide& side, const DeviceSample& sample, const Pose& tool) {
  side.epoch = sample.epoch;
  choose_springs(side, sample.traits);
  side.books = {};
  OutputGuard guard;
  guard.force_heat = side.guard.force_heat;  // motors that are hot stay so
  guard.torque_heat = side.guard.torque_heat;
  guard.checked = !side.safety.checks_signs;
  guard.signs = guard.checked ? SignVerdict::kRight : guard.signs;  // as somebody has said
  const bool same = sample.plugged == side.plugged && side.couplings > 1;
  if (same) {
    // After a silence: its signs are what they were, and it is off if it was.
    guard.checked = guard.checked || side.guard.checked;
    guard.risen = side.guard.risen;
    guard.signs = side.guard.signs;
    guard.state = side.guard.state == GuardState::kOff ? GuardState::kOff : guard.state;
    guard.reason = side.guard.state == GuardState::kOff ? side.guard.reason : guard.reason;
  } else {
    begin_sign_check(
        side.signs, felt_axes(sample),
        {kShareOfCheck * side.coupling.largest_force, kShareOfCheck * side.coupling.largest_torque},
        side.home.rotation, sample.traits.delay);
  }
  side.plugged = sample.plugged;
  side.guard = guard;
  side.speed = {sample.pose, glm::dvec3(0.0), 0.0};
  side.limits.largest_force = side.coupling.largest_force;
  side.limits.largest_torque = side.coupling.largest_torque;
  side.limits.largest_force_rate = side.coupling.largest_force / kRiseTime;
  side.limits.largest_torque_rate = side.coupling.largest_torque / kRiseTime;
  side.limits.near = kNearHandle;
  side.map.origin =
      has_no_place(sample) ? tool.position - sample.pose.position : side.home.position;
}

/// Until it takes hold, the handle has the tool's orientation, however it is held.
void wait_for_hold(HandleSide& side, const DeviceSample& sample, const Pose& tool) {
  side.device = sample.pose;
  side.map.turned = sample.pose.rotation;
  side.map.rotation = tool.rotation;
  if (has_no_place(sample)) {
    side.map.origin = tool.position - sample.pose.position;
  }
  begin_group_anew(side.signs);
  side.books = {};
  side.last = handle_pose(side.map, side.device);
}

/// What the springs pull at: what the encoders say, or what stands still while their counts toggle.
Pose pulling_pose(const HandleSide& side, const DeviceSample& sample) {
  const VirtualCoupling& springs = side.coupling;
  const DeviceTraits& device = sample.traits;
  Pose pose = sample.pose;
  if (needs_play(device.encoder_step, springs.stiffness, springs.largest_force)) {
    pose.position = side.device.position;
  }
  if (needs_turn_play(device.encoder_turn_step, springs.turn_stiffness, springs.largest_torque)) {
    pose.rotation = side.device.rotation;
  }
  return pose;
}

/// What the guard is told of the device itself.
GuardInput guard_input(HandleSide& side, const DeviceSample& sample, double period) {
  GuardInput input;
  input.live = sample.state == DeviceState::kLive;
  input.held = side.safety.held_buttons == 0 || (sample.buttons & side.safety.held_buttons) != 0;
  if (!input.live) {
    return input;
  }
  if (!sample.steers_rate || sample.actuated != kNoAxes) {
    measure_speed(side.speed, sample.pose, period);
  }
  if ((sample.actuated & kTranslationAxes) != 0) {
    const double most = kMostOfWeight * side.limits.largest_force;
    input.weight.y = std::min(sample.traits.weight, most);
  }
  input.velocity = side.speed.velocity;
  input.turn_speed = side.speed.turn_speed;
  if (side.guard.state == GuardState::kChecking) {
    input.signs = take_sign_sample(side.signs, sample.pose, period);
  }
  input.probe = sign_probe(side.signs);
  ThermalLimit& force = side.guard.force_heat;
  ThermalLimit& torque = side.guard.torque_heat;
  force.continuous = first_known(side.safety.continuous_force, sample.traits.continuous_force);
  torque.continuous = first_known(side.safety.continuous_torque, sample.traits.continuous_torque);
  force.time = first_known(sample.traits.thermal_time, ThermalLimit{}.time);
  torque.time = force.time;
  return input;
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
  const bool was_silent =
      now - side.last_time > std::max(side.limits.longest_gap, kGapPeriods * sample.traits.period);
  if (live && !begins && was_silent) {
    // What the motors hold is nothing: the force comes back as after any fault.
    side.guard.sent = {};
    side.guard.carried = {};
  }
  const bool waits = live && side.guard.state == GuardState::kWaiting;
  const double elapsed = std::clamp(now - side.last_time, kShortestPeriod, kLongestPeriod);
  const double period = waits ? kUsualPeriod : elapsed;
  Pose steady_before = handle_pose(side.map, side.device);
  if (waits) {
    wait_for_hold(side, sample, tool);
    steady_before = side.last;
  } else if (live) {
    side.device = follow_counts(side.device, sample.pose, sample.traits.encoder_step,
                                sample.traits.encoder_turn_step, period);
  }
  outcome.handle = live ? handle_pose(side.map, pulling_pose(side, sample)) : side.last;
  // The toggling of a count would look like a way to and fro, and be damped by a pulse each time.
  const Pose steady = handle_pose(side.map, side.device);
  const Wrench wanted =
      keep_passive(side.books, side.passivity,
                   felt_wrench(side.hold, side.coupling, outcome.handle, tool, result.contact),
                   steady.position - steady_before.position,
                   turn_between(steady_before.rotation, steady.rotation), period);
  outcome.distance = glm::length(outcome.handle.position - tool.position);
  GuardInput input = guard_input(side, sample, std::max(now - side.last_time, kShortestPeriod));
  input.wanted = wanted;
  input.result_age = result.any ? now - result.time : 1.0;
  input.faulty = result.faulty;
  input.live = input.live && (begins || !was_silent);
  input.distance = outcome.distance;
  const bool was_checked = side.guard.checked;
  outcome.sent = guard_output(side.guard, side.limits, input, period);
  outcome.wrench = side.guard.sent;
  note_sent(side.books, outcome.wrench);
  if (side.guard.checked && !was_checked) {
    choose_springs(side, sample.traits);
  }
  if (sample.state == DeviceState::kAbsent) {  // nothing displays what falls
    side.guard.state = GuardState::kWaiting;   // a device that was off has gone
    side.guard.sent = {};
    side.guard.carried = {};
    outcome.sent = {};
    outcome.wrench = {};
  }
  outcome.holds = live && side.guard.state != GuardState::kWaiting;
  side.last = outcome.handle;
  side.last_time = now;
  return outcome;
}

}  // namespace torsion::engine
