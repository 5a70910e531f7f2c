#include "systems/hold/handle_side.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "systems/hold/count_play.hpp"
#include "systems/hold/coupling_choice.hpp"
#include "systems/math/rotation_vector.hpp"

namespace torsion {
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

/// Until it takes hold the handle is turned as the tool is, however it is held.
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

}  // namespace torsion
