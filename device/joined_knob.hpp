#pragma once

// A knob or a wheel on the USB that turns the tool which a gateway's client moves: what passes
// between their two threads. Neither waits for the other.

#include "ecs/device_sample.hpp"
#include "ecs/triple_buffer.hpp"

namespace torsion::engine {

/// What the knob is to display.
struct KnobTorque {
  double torque = 0.0;  // N m, about the turn axis
  double time = 0.0;    // s, steady clock; 0: never
};

struct JoinedKnob {
  glm::dvec3 axis{0.0, 1.0, 0.0};      // world, at rest: what it turns the tool about
  TripleBuffer<DeviceSample> samples;  // written by the USB's thread
  TripleBuffer<KnobTorque> torques;    // written by the gateway's
};

/// In the USB's thread: a sample of the knob.
/// @return the wrench that it is to display: nothing where the last is too old
Wrench take_knob_sample(JoinedKnob& knob, const DeviceSample& sample);

/// In the gateway's thread: adds the knob's turn to the client's sample, and what it displays. The
/// whole is live when both are; who is not says why.
void join_knob(JoinedKnob& knob, DeviceSample& sample);

/// Likewise: the knob's part of the wrench on the tool, which is at `sample` now.
void ask_knob(JoinedKnob& knob, const DeviceSample& sample, const Wrench& wrench);

}  // namespace torsion::engine
