#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion {

/// ContactLaw::join. Lets a region take over what another one that ends holds: its grid is
/// laid around the loaded cells of both, the other's pressures and tractions are added, and what
/// that one's load does to the body here is by its own load from now on.
/// Nothing where one of both has no solution that has settled.
/// @pre the rows of the one that ends are still what they were
void join_patch(StepContext& context, std::uint32_t ended, std::uint32_t heir);

}  // namespace torsion
