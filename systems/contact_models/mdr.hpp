#pragma once

#include "systems/step.hpp"

namespace torsion {

// The contact model `mdr`: each region is a round, or nearly round, contact of an elastic
// half-space (docs/models.md).

/// Normal force, friction and couple of every region of a body with this model. Writes MdrLayer,
/// MdrState, CellTraction, RegionCarrier, RegionNormal, RegionFriction and, from the contact's
/// ellipse, RegionGeometry.
void mdr_forces(StepContext& context);

/// Normal force on a bonded incompressible or compressible layer over that on a half-space, at
/// equal depth. Within 2 % up to chi = 0.26 (nu = 0.5), 7.7 % off at 0.5;
/// larger values are taken as 0.5. Source:
/// Dimitriadis et al., Biophys. J. 82 (2002) 2798.
/// @param chi  sqrt(R depth) / thickness
double layer_force_share(double chi, double poisson_ratio);

}  // namespace torsion
