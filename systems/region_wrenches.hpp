#pragma once

#include <cstdint>

#include "systems/step.hpp"

namespace torsion {

/// What of a region does not change little by little in this step.
enum class RegionEvent : std::uint32_t {
  kNone,
  kTakesOver,    // on_tool holds what it goes on from: it is new, or another's or its own heir
  kGridLaidAnew  // contact model patch, by interpolation
};

/// Force and torque of every region on its tool, about the tool's mass centre, in the world: T =
/// (p_eq - c) x F plus the friction couple about the normal (equation (1) with the sign of
/// docs/models.md). What a birth, merge, split or a grid laid anew would make jump is let out over
/// kEventFade seconds instead.
void region_wrenches(StepContext& context);

/// Adds the regions' wrenches on every tool, and the work of the tool's holder. After a fault what
/// is let out falls from the last good wrench to zero and, once the fault is over, rises again; a
/// wrench that is not finite never gets out.
void sum_wrenches(StepContext& context);

}  // namespace torsion
