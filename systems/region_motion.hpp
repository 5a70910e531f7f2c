#pragma once

#include "systems/step.hpp"

namespace torsion {

/// How the tool moves over the body at each region in this step, and where its rotation axis goes
/// (section III of the paper): slide and spin in the tangent plane, the turn phi summed from the
/// spin since the region formed (integral of omega . n dt, not read off a quaternion), whether the
/// axis goes through the region's disc of radius a, and the lever l to what is fixed. The change
/// between "through" and "past" is spread over the outermost tenth of the disc, so that the torque
/// is continuous.
void region_motion(StepContext& context);

}  // namespace torsion
