#pragma once

#include <array>
#include <cstdint>

#include "ecs/components.hpp"
#include "ecs/device_sample.hpp"
#include "systems/hold/tool_hold.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion::engine {

/// Where a handle is taken to be whose encoders count: the pose nearest to the last one that is
/// within two counts of what they say, on each axis, and from there slowly to within one. A handle
/// that trembles about the edge of a count stands still; with a coupling on what the encoders say
/// themselves the force would toggle there by the stiffness times a count, late, which is a relay
/// and feeds an oscillation.
///
/// A pose that moves at once when it is W counts behind is a relay, too, of hysteresis. By its
/// describing function (Gelb & Vander Velde, 1968, ch. 2) it does not oscillate where
/// -Im L(i w) < pi/2 W at every frequency w, for the loop L = K exp(-i w t_d) / (k + i w c - m w^2)
/// of a coupling K and a hand k, c, m. With K = 200 N/m, t_d = 4.5 ms, m = 0.15 kg and c = 6 N s/m
/// that asks for W > 0.65 with a hand of 200 N/m and W > 1.63 with a loose one of 50 N/m: two.
///
/// That is no place to rest yet: a count of the pose moves a loose hand by K / k = 4 counts, out of
/// the 3 in which what the encoders say stays within one count of it. The slow way between does not
/// jump, so that there is such a place for every hand, and lets the hand follow, whose slowest time
/// is c / k = 0.12 s.
///
/// Moving, the pose lags behind by up to two and a half counts, which over a way s of the handle
/// costs an energy of up to K (5/2 count) s; the passivity controller sees it.
/// @param last        what this returned before
/// @param measured    what the encoders say
/// @param count       m; 0: they do not count, and `measured` is returned
/// @param turn_count  rad, likewise
/// @param period      s, since `last`
Pose follow_counts(const Pose& last, const Pose& measured, double count, double turn_count,
                   double period);

inline constexpr std::uint32_t kLongestDelay = 15;  // samples

/// Books of one channel, translation or rotation, of a device that holds its force between two
/// samples.
struct EnergyBooks {
  double stored = 0.0;      // J: what the hand has put in and not got back; below 0 it got more
  double dissipated = 0.0;  // J: what the controller has taken, ever
};

/// Time-domain passivity observer and controller of the wrench that a device displays. Source:
/// Hannaford & Ryu, 2002; energy of the past interval exact for a held force, Ryu et al., 2004.
struct PassivityState {
  EnergyBooks translation;
  EnergyBooks rotation;
  std::array<Wrench, kLongestDelay + 1> sent{};  // the last ones, round
  std::uint32_t samples = 0;
};

struct PassivityLimits {
  double largest_damping = 0.0;       // N s/m that the controller may add; below 2 m / T
  double largest_turn_damping = 0.0;  // N m s/rad; below 2 I / T
  /// J: more than this is not kept in the books, so that a long passive past does not pay for a
  /// burst.
  double largest_stored = 0.01;
  std::uint32_t delay = 0;  // samples from a wrench sent to where it is held, up to kLongestDelay
};

/// What the controller may do on a device. A damper that is sampled and late is itself passive only
/// up to about m / (T + 2 t_d), half of which is taken; and one count of the encoders, which looks
/// like a speed of a count in a sample, must not make more than a fiftieth of the device's force.
/// A device whose mass or inertia is not known is taken for a light one.
PassivityLimits choose_passivity(const DeviceTraits& device);

/// One sample.
/// @param wanted  wrench to display on the hand, world axes
/// @param shift   m: how the handle moved since the last sample
/// @param turn    rad, rotation vector, likewise
/// @param period  s
/// @return the wrench to display: `wanted` and, while more energy came out than went in, a damping
Wrench keep_passive(PassivityState& state, const PassivityLimits& limits, const Wrench& wanted,
                    const glm::dvec3& shift, const glm::dvec3& turn, double period);

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

/// Where a device's poses are in the world.
struct HandleMap {
  glm::dvec3 origin{0.0};                   // m: of the device's workspace
  glm::dquat turned{1.0, 0.0, 0.0, 0.0};    // the device's rotation when it took hold of the tool
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  // the tool's then
};

/// The pose that the handle asks of the tool's frame, world.
Pose handle_pose(const HandleMap& map, const Pose& device);

/// What the device's thread keeps of a held tool: all that stands between the newest result of the
/// physics and the wrench that is sent.
struct HandleSide {
  Pose home;  // of the tool, world: where the centre of a device's workspace is
  ToolHold hold = ToolHold::kMassless;
  HandleMap map;
  VirtualCoupling coupling;
  PassivityLimits passivity;
  PassivityState books;
  GuardLimits limits;
  OutputGuard guard;
  Pose device;              // of the device's handle, as far as its counts go
  Pose last;                // m, world: of the handle in the sample before
  double last_time = 0.0;   // s: of that sample
  std::uint32_t epoch = 0;  // of the device
};

/// The newest that the physics said.
struct PhysicsResult {
  Pose tool;          // world
  double time = 0.0;  // s, steady clock
  bool faulty = false;
  bool any = false;  // false: nothing was said yet
  Wrench contact{};  // of the bodies on the tool, about its frame's origin, world axes
};

struct HandleOutcome {
  Pose handle;            // world
  Wrench wrench;          // to display, about the handle, world axes
  double distance = 0.0;  // m: from handle to tool
  bool holds = false;     // whether the handle moves the tool; else it is to be brought to it
};

/// One sample of the device. A new epoch of the device begins without force, with the coupling that
/// its traits allow, and takes hold of the tool where the handle is near it. A device that steers a
/// rate is put where the tool is.
/// @param now  s, steady clock
HandleOutcome take_handle_sample(HandleSide& side, const DeviceSample& sample,
                                 const PhysicsResult& result, double now);

}  // namespace torsion::engine
