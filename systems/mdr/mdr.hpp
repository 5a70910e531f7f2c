#pragma once

#include "systems/contact/law.hpp"

namespace torsion {

// The contact model `mdr`: each region is a round, or nearly round, contact of an elastic
// half-space (docs/models.md).

/// Normal force, friction and couple of every region of a body with this model. Writes MdrLayer,
/// MdrState, CellTraction, RegionCarrier, RegionNormal, RegionFriction and, from the contact's
/// ellipse, Contact.
void mdr_forces(StepContext& context);

}  // namespace torsion
