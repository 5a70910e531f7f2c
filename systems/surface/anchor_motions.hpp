#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion {

/// Where the anchors of bodies with body model compliance are under the tractions of all regions,
/// for those who draw them. Writes AnchorMotion and AnchorTurns.
void anchor_motions(StepContext& context);

}  // namespace torsion
