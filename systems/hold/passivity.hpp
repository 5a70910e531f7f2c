#pragma once

#include <array>
#include <cstdint>

#include "ecs/components.hpp"
#include "ecs/device_sample.hpp"

namespace torsion::engine {

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

/// What the device was sent in place of what keep_passive() returned last: the books are of that.
void note_sent(PassivityState& state, const Wrench& sent);

}  // namespace torsion::engine
