#pragma once

#include "systems/step.hpp"

namespace torsion {

/// The last line, whatever the cause: raises Fault::kForceTooLarge where a region's normal force is
/// beyond what a rigid punch that holds its overlap with the rest shape would need to be pressed in
/// as deep as that is and as far as the body's other regions may push it against this one.
void bound_forces(StepContext& context);

}  // namespace torsion
