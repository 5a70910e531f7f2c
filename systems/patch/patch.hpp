#pragma once

#include "systems/contact/law.hpp"

namespace torsion {

// The contact model `patch`: each region is a piece of an elastic half-space under a grid of cells,
// with pressure and Coulomb friction solved together (docs/models.md).

/// Pressures, tractions, forces and couple of every region of a body with this model. Writes
/// CellTraction, all PatchValue, PatchState, PatchEnergy, RegionCarrier, RegionNormal,
/// RegionFriction and Contact.
void patch_forces(StepContext& context);

}  // namespace torsion
