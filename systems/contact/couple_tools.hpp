#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion {

/// Takes the input poses as the tools' new poses (a scripted pose is imposed as it is) and derives
/// their motion over the step: velocity of the mass centre, angular velocity, and the rotation
/// axis. A pose that is not finite is refused and one that moved further than a hand can is taken
/// without motion; both set a fault.
void couple_tools(StepContext& context);

}  // namespace torsion
