#pragma once

// A shipped scene in an emulated hand, with no hardware: what the device's thread runs, the step,
// and the hand, one after the other.

#include <cstdint>
#include <functional>
#include <string>

#include "ecs/world.hpp"
#include "tests/systems/hold/emulated_hand.hpp"

namespace torsion::engine::test {

struct LoopOutcome {
  double force = 0.0;           // N: length of the mean over the last half of the hold
  double ripple = 0.0;          // N: farthest from it
  double torque = 0.0;          // N m
  double turn_ripple = 0.0;     // N m
  double most_gained = 0.0;     // J: the most that the motors had given to the hand at any time
  double gained_at_rest = 0.0;  // J: likewise since the last half of the hold began
  double one_sample = 0.0;      // J: the most that they did in one sample
  std::uint32_t faults = 0;
};

/// What is held, and with which models instead of those that the scene asks for.
struct HeldScene {
  std::string name;  // path in scenes/, or the name of a .gltf there
  ContactModel contact_model = ContactModel::kAuto;
  BodyModel body_model = BodyModel::kAuto;
};

/// When the animation presses hardest, s.
double hardest(const HeldScene& scene);

/// The person follows the first tool's animation until the time `until`, and holds it there for
/// `seconds`.
/// @param after_step  is shown the world after every step, if set
LoopOutcome hold(const HeldScene& scene, const HandTraits& traits, double until, double seconds,
                 const std::function<void(const World&)>& after_step = {});

}  // namespace torsion::engine::test
