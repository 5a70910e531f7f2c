#pragma once

// Where a tool's and a body's smooth exact surfaces lie deepest in each other, from the shapes
// themselves and not from samples or cells: the same whichever way the scene is turned or mirrored,
// and a depth whose change is the motion along the common normal, so that a force of it alone does
// no work around a closed path.

#include <cstdint>

#include "systems/contact/step_context.hpp"

namespace torsion {

/// Finds a region's SmoothContact. Where it is known it also turns RegionFrame to the common normal
/// and moves Overlap's points and its largest depth to the deepest place. For ContactLaw::refine.
void refine_overlap(StepContext& context, std::uint32_t region);

}  // namespace torsion
