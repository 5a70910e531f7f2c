#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "ecs/state.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

inline void raise(Clock& clock, Fault fault) {
  clock.faults |= static_cast<std::uint32_t>(fault);
}

inline bool raised(std::uint32_t faults, Fault fault) {
  return (faults & static_cast<std::uint32_t>(fault)) != 0;
}

/// What a fault means and what to do about it, one sentence.
std::string_view fault_text(Fault fault);

/// The faults in words, one a line; empty where there are none.
/// @param faults  bits of Fault
std::string faults_text(std::uint32_t faults);

inline constexpr Fault kAllFaults[] = {Fault::kPoseNotFinite,   Fault::kPoseJumped,
                                       Fault::kTooDeep,         Fault::kRegionsFull,
                                       Fault::kResultNotFinite, Fault::kForceTooLarge};

/// The last line of defence, whatever the cause: raises Fault::kForceTooLarge where a region's
/// normal force F is beyond either of two bounds, in which k is the stiffness of a rigid punch that
/// holds the region's contact and d is how deep the body's regions together are under its rest
/// shape.
/// - F^2 / (2 k) <= W: no contact of that size holds F with less energy, and W is what the tools
///   have put in since nothing touched the body. Where regions come up at a depth that no motion
///   has brought them to, W is at least k d^2 / 2.
/// - F <= k d, on a body that does not move as a whole. One that does may be dragged against a tool
///   by friction, the more the harder that presses: nothing but energy bounds that.
/// The force of `paper` is a formula of the depth, which stiffens without bound: it is left alone.
void bound_forces(StepContext& context);

/// What makes a region's force jump in this step.
enum class RegionEvent : std::uint32_t {
  kNone,
  kBegins,      // on_tool is zero: it is new, where there was none; what the tool's way in this
                // step has made of it is felt at once
  kTakesOver,   // on_tool holds what it goes on from: another's or its own heir, or split off one
  kRegridded,   // contact model patch, by interpolation
  kBodyFollows  // to kBodyFollows + kFollowingSteps - 1, one after the other: the whole body
                // answers to regions that took over, of which it may be one
};

/// Steps in which a body with compliance answers to regions that merge or split. Their contact is
/// found on the body as the step before has left it, without or with what the one region moved the
/// other (a tenth of the depth), and Newton's method makes one iteration in a step: where two balls
/// of patch part, the force is 23 % off in the step itself and 2.7, 2.3, 0.9, 0.6 and 0.1 % in
/// those after it; where two of mdr meet, 19, 2.1 and 0.1 %.
inline constexpr std::uint32_t kFollowingSteps = 4;

/// Force and torque of every region on its tool, about the tool's mass centre, in the world: T =
/// (p_eq - c) x F plus the friction couple about the normal (equation (1) with the sign of
/// docs/models.md). What a birth, merge, split or regridding would make jump is faded in over
/// kEventFade seconds instead, on a body with compliance from when that has answered.
void region_wrenches(StepContext& context);

/// Adds the regions' wrenches on every tool, and the work of the tool's holder. After a fault what
/// is output falls from the last good wrench to zero and, once the fault is over, rises again; a
/// wrench that is not finite never gets out.
void sum_wrenches(StepContext& context);

}  // namespace torsion::engine
