#pragma once

#include <cstdint>

#include "ecs/components.hpp"

namespace torsion {

/// What a device may be sent.
struct GuardLimits {
  double largest_force = 0.0;        // N
  double largest_torque = 0.0;       // N m
  double largest_force_rate = 0.0;   // N/s
  double largest_torque_rate = 0.0;  // N m/s
  double longest_silence = 3e-3;     // s: without a result of the physics
  double fall = 10e-3;               // s: from any wrench to none
  double rise = 50e-3;               // s: back
  double near = 5e-3;                // m: between handle and tool, to begin with
};

enum class GuardState : std::uint8_t {
  kWaiting,  // nothing is sent until the handle is at the tool
  kRising,
  kLive,
  kFalling,  // the physics is silent, or said that something is wrong
};

struct OutputGuard {
  GuardState state = GuardState::kWaiting;
  double share = 0.0;
  Wrench last_good;  // what falls
  Wrench sent;
};

/// What the guard goes by in one sample of the device.
struct GuardInput {
  Wrench wanted;
  double result_age = 0.0;  // s: of the newest result of the physics
  bool faulty = false;      // the physics or the device says so
  double distance = 0.0;    // m: from handle to tool
};

/// One sample: the wrench to send. Never more than the limits, never faster, nothing that is not
/// finite, and no share of a result that is too old. After a fall it waits again for the handle.
/// @param period  s
Wrench guard_output(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
                    double period);

}  // namespace torsion
