#pragma once

// What a device is sent at most, and when it is sent nothing: docs/devices.md draws the states.

#include "ecs/components.hpp"
#include "systems/hold/sign_check.hpp"
#include "systems/hold/thermal_limit.hpp"

namespace torsion::engine {

/// What a device may be sent.
struct GuardLimits {
  double largest_force = 0.0;        // N
  double largest_torque = 0.0;       // N m
  double largest_force_rate = 0.0;   // N/s
  double largest_torque_rate = 0.0;  // N m/s
  double longest_silence = 3e-3;     // s: without a result of the physics
  // s: between two samples of the device, or two and a half of its periods; after longer its driver
  // has told the motors to let go
  double longest_gap = 4e-3;
  double fall = 10e-3;               // s: from any wrench to none
  double first_rise = 1.0;           // s: to what is wanted, the first time
  double rise = 50e-3;               // s: back
  double near = 5e-3;                // m: between handle and tool, to begin with
  double largest_speed = 1.2;        // m/s, as OpenHaptics has it (HD_SOFTWARE_VELOCITY_LIMIT)
  double largest_turn_speed = 40.0;  // rad/s: a wrist makes half of it
  // Nobody pushes as fast as this for as long against a first force of unknown signs: m/s, s. One
  // packet that is wrong is over sooner.
  double largest_unchecked_speed = 0.3;
  double longest_against = 30e-3;
};

enum class GuardState : std::uint8_t {
  kWaiting,   // nothing is sent until the handle is at the tool, and held if it has to be
  kChecking,  // a little is sent to see whether it goes where it is pushed
  kRising,
  kLive,
  kFalling,  // something is wrong: to nothing, and then it waits
  kOff,      // nothing is sent until the device begins anew
};

/// Why nothing is sent, or less and less.
enum class GuardReason : std::uint8_t {
  kNone,
  kFar,       // the handle is not at the tool yet
  kLetGo,     // the button that has to be held is not
  kPhysics,   // it is silent, or has a fault
  kNotLive,   // the device is not
  kTooFast,   // the handle moved faster than a hand should
  kReversed,  // it goes the other way than it is pushed
  kRanAway,   // it ran against the force, faster and faster, with signs that nothing had shown
};

struct OutputGuard {
  GuardState state = GuardState::kWaiting;
  GuardReason reason = GuardReason::kFar;  // of kWaiting, kFalling and kOff
  bool checked = false;                    // its signs were looked at
  bool risen = false;                      // it was live once
  SignVerdict signs = SignVerdict::kRunning;
  double share = 0.0;
  double against_for = 0.0;  // s: that it has gone against the force so fast
  Wrench last_good;          // what falls
  Wrench sent;               // without what carries the device
  glm::dvec3 last_carried{0.0};
  glm::dvec3 carried{0.0};  // N: what carries the device
  ThermalLimit force_heat;
  ThermalLimit torque_heat;
};

/// What the guard goes by in one sample of the device.
struct GuardInput {
  Wrench wanted;
  glm::dvec3 weight{0.0};                        // N: carries the device itself, world axes
  Wrench probe;                                  // of the sign check, to be sent while it goes on
  double result_age = 0.0;                       // s: of the newest result of the physics
  bool faulty = false;                           // the physics says so
  bool live = true;                              // the device is
  bool held = true;                              // the button is, if one has to be
  double distance = 0.0;                         // m: from handle to tool
  glm::dvec3 velocity{0.0};                      // m/s, of the handle, world axes
  double turn_speed = 0.0;                       // rad/s
  SignVerdict signs = SignVerdict::kUnresolved;  // of the check; kRunning: it goes on
};

/// One sample: the wrench to send, `sent` and `carried` together. Never more than the limits, never
/// faster, no more for long than the motors bear, nothing that is not finite, and no share of a
/// result that is too old. After a fall it waits again for the handle; a device that goes the wrong
/// way stays off.
/// @param period  s
Wrench guard_output(OutputGuard& guard, const GuardLimits& limits, const GuardInput& input,
                    double period);

}  // namespace torsion::engine
