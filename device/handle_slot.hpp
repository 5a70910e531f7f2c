#pragma once

#include <cstdint>

#include "ecs/components.hpp"
#include "ecs/device_sample.hpp"
#include "ecs/triple_buffer.hpp"

namespace torsion::engine {

/// Where a hand holds a tool: what a mouse or a device tells the physics thread.
struct HandleSample {
  Pose pose;                  // asked of the tool's frame, world
  std::uint64_t number = 0;   // counts the samples, from 1; 0: nothing was said yet
  std::int64_t time_ns = 0;   // CLOCK_MONOTONIC, when it was measured; 0: not known
  std::uint32_t buttons = 0;  // bits
  std::uint32_t epoch = 0;    // of a device: another one has another coupling; 0: a mouse
  DeviceTraits traits;        // of a device
};

/// What the physics thread answers after each step.
struct HandleAnswer {
  Wrench wrench;             // that the handle is to feel, about its origin, world
  Pose tool;                 // where the tool is
  Wrench contact;            // of the bodies on the tool, about its frame's origin, world
  double distance = 0.0;     // m: from handle to tool
  std::uint64_t sample = 0;  // the number of the sample that it answers
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, when the step was done
  std::uint32_t faults = 0;  // bits of Fault
  std::uint32_t padding = 0;
};

/// Between one handle's thread and the physics thread: the newest value counts, nobody waits.
struct HandleSlot {
  TripleBuffer<HandleSample> sample;  // written by the handle's thread
  TripleBuffer<HandleAnswer> answer;  // written by the physics thread
};

}  // namespace torsion::engine
