#include "device/joined_knob.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace torsion::engine {

Wrench take_knob_sample(JoinedKnob& knob, const DeviceSample& sample) {
  constexpr double kOldTorque = 4e-3;  // s: who asked for it is silent
  knob.samples.back() = sample;
  knob.samples.publish();
  knob.torques.refresh();
  const KnobTorque& asked = knob.torques.front();
  const bool fresh = sample.time - asked.time <= kOldTorque;
  return {glm::dvec3(0.0), fresh ? asked.torque * knob.axis : glm::dvec3(0.0)};
}

void join_knob(JoinedKnob& knob, DeviceSample& sample) {
  constexpr double kOldSample = 25e-3;  // s: the slowest knob's period, and it is dead
  knob.samples.refresh();
  const DeviceSample& turned = knob.samples.front();
  // Another one of either begins anew.
  sample.epoch += turned.epoch;
  sample.plugged += turned.plugged;
  const bool turns = turned.state == DeviceState::kLive &&
                     sample.time - turned.time <= kOldSample && turned.number > 0;
  if (!turns) {
    if (sample.state == DeviceState::kLive) {
      sample.state = DeviceState::kStarting;
      sample.trouble =
          turned.trouble != DeviceTrouble::kNone ? turned.trouble : DeviceTrouble::kSilent;
      sample.motor = turned.motor;
      sample.motor_errors = turned.motor_errors;
    }
    return;
  }
  sample.pose.rotation = sample.pose.rotation * turned.pose.rotation;
  sample.buttons |= turned.buttons;
  sample.garbage += turned.garbage;
  sample.sensed |= kTurnAxis;
  sample.actuated |= turned.actuated & kTurnAxis;
  DeviceTraits& whole = sample.traits;
  const DeviceTraits& part = turned.traits;
  whole.largest_torque = std::max(whole.largest_torque, part.largest_torque);
  whole.continuous_torque = std::max(whole.continuous_torque, part.continuous_torque);
  whole.encoder_turn_step = std::max(whole.encoder_turn_step, part.encoder_turn_step);
  whole.turn_damping = part.turn_damping;
  whole.inertia = part.inertia;
  whole.delay = std::max(whole.delay, part.delay);
  whole.period = std::max(whole.period, part.period);
  whole.thermal_time = whole.thermal_time > 0.0 && part.thermal_time > 0.0
                           ? std::min(whole.thermal_time, part.thermal_time)
                           : std::max(whole.thermal_time, part.thermal_time);
}

void ask_knob(JoinedKnob& knob, const DeviceSample& sample, const Wrench& wrench) {
  KnobTorque& asked = knob.torques.back();
  asked.torque = glm::dot(wrench.torque, sample.pose.rotation * knob.axis);
  asked.time = sample.state == DeviceState::kLive ? sample.time : 0.0;
  knob.torques.publish();
}

}  // namespace torsion::engine
