#pragma once

#include "systems/step.hpp"

namespace torsion {

/// System: a region's grid follows the contact, but the tractions belong to places on the body.
/// Where the grid has moved, grown or shrunk, each cell takes the tractions from where it now is,
/// between the old cells; new area starts without any, area that is left loses its own.
void carry_tractions(StepContext& context);

}  // namespace torsion
