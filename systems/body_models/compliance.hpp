#pragma once

#include "systems/step.hpp"

namespace torsion {

/// The body's own compliance in series with its contacts: how far the material under each region
/// has gone as a rigid body under the wrenches of all regions of the body. Reads RegionNormal,
/// RegionFriction, RegionGeometry; writes RegionSupport.
///
/// One step of a quasi-Newton method for u = C f(u), all regions at once, so their order does not
/// matter: du = (I + C K)^-1 (C f - u), with K the contacts' stiffness without slip. Where a
/// contact slips K is too large and du too small, so it converges all the same.
void compliance(StepContext& context);

/// Where the anchors of bodies with body model compliance are under the same wrenches, for those
/// who draw them. Writes AnchorMotion and AnchorTurns.
void anchor_motions(StepContext& context);

}  // namespace torsion
