#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion {

/// ContactLaw::split. Begins a region that splits off another one as that one is: on the
/// same grid, with the same pressures and tractions. Which of the cells are whose is found with the
/// tool's surface; then share_out_patch tells them apart.
/// Nothing where that one has no solution (PatchState::started).
void copy_patch(State& state, std::uint32_t from, std::uint32_t region);

/// ContactLaw::share_out. Takes from a region that was copied in this step, and from the one that
/// it was copied from, the tractions on cells that have become the other's, and lets each know what
/// the other's load does to the body under it: nothing but the tool's motion is to change the sum
/// of their forces.
void share_out_patch(StepContext& context, std::uint32_t region);

}  // namespace torsion
