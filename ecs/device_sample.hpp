#pragma once

// What crosses between a device that a person holds and the simulation.

#include <cstdint>

#include "ecs/components.hpp"

namespace torsion::engine {

/// What a device measures, or pushes on: sums of these.
enum DeviceAxes : std::uint8_t {
  kNoAxes = 0,
  kTranslationAxes = 1,
  kRotationAxes = 2,  // all three
  kTurnAxis = 4,      // only about the tool's own y axis
};

enum class DeviceState : std::uint8_t {
  kAbsent,    // nothing is plugged in, or it was pulled out
  kStarting,  // set up, waiting for its zero, or for a part of a device of several parts
  kLive,
};

/// Why a device does not work, or not yet.
enum class DeviceTrouble : std::uint8_t {
  kNone,
  kNoAccess,       // the system lets this user not open it
  kHeldElsewhere,  // another program has it
  kNoFirmware,     // it needs a file that the user must give
  kBadFirmware,    // it did not take that file
  kWrongFirmware,  // it has another version than those that are understood
  kNotHomed,       // the user must move it through its range
  kNotMoved,       // it says where it is when it moves, and has not moved yet
  kSilent,         // it does not answer
  kNotUnderstood,  // it answers something else
  kNoClient,       // of the gateway: nobody is there, or who was fell silent
  kWrongSecret,    // of the gateway: who is there does not have its secret
  kMotorError,     // its motor's controller has let go: DeviceSample::motor_errors
};

/// Whose numbers DeviceSample::motor_errors are.
enum class MotorKind : std::uint8_t { kOdrive5, kOdrive6, kMoteus, kWheel };

/// What a device is, as far as stability asks. Zero where it is not known.
struct DeviceTraits {
  double damping = 0.0;            // b, N s/m: of the handle without motors on
  double turn_damping = 0.0;       // N m s/rad
  double mass = 0.0;               // kg: of handle and mechanism
  double inertia = 0.0;            // kg m^2
  double encoder_step = 0.0;       // m: one count, at the handle
  double encoder_turn_step = 0.0;  // rad
  double period = 1e-3;            // T, s: between two forces
  double delay = 0.0;             // t_d, s: from a position read to its force sent, beyond the hold
  double largest_force = 0.0;     // N
  double largest_torque = 0.0;    // N m; zero: the device has no torque
  double continuous_force = 0.0;  // N: that its motors bear for ever
  double continuous_torque = 0.0;       // N m
  double thermal_time = 0.0;            // s: in which they get warm
  double largest_stiffness = 0.0;       // N/m, as its maker says
  double largest_turn_stiffness = 0.0;  // N m/rad
  double weight = 0.0;  // N: upwards, it carries handle and mechanism in the middle of their range
};

/// A device at one moment.
struct DeviceSample {
  Pose pose;                  // of the handle from the centre of its workspace, world axes (+Y up,
                              // +Z towards the user)
  std::uint32_t buttons = 0;  // one bit each
  DeviceState state = DeviceState::kAbsent;
  DeviceTrouble trouble = DeviceTrouble::kNone;
  std::uint32_t motor_errors = 0;  // of kMotorError: as the motor's controller numbers them
  MotorKind motor = MotorKind::kOdrive5;
  std::uint8_t sensed = kNoAxes;    // of DeviceAxes
  std::uint8_t actuated = kNoAxes;  // likewise
  bool steers_rate = false;   // it has no place of its own: its pose is where it was steered to
  bool buttons_turn = false;  // it senses no turn: two of its buttons make one
  std::uint32_t epoch = 0;    // another one: the pose starts anew and may be anywhere
  std::uint32_t plugged = 0;  // counts what was plugged in, or a gateway's clients: another one may
                              // have other signs
  std::uint64_t number = 0;   // of the samples so far
  double time = 0.0;          // s, steady clock, when it arrived
  std::uint64_t garbage = 0;  // packets so far that were none
  DeviceTraits traits;
  double rate = 0.0;  // Hz, of the last samples
};

}  // namespace torsion::engine
