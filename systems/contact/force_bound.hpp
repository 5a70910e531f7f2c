#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion {

/// The last line, whatever the cause: raises Fault::kForceTooLarge where a region's normal force F
/// is beyond either of two bounds, in which k is the stiffness of a rigid punch that holds the
/// region's contact and d is how deep the body's regions together are under its rest shape.
/// - F^2 / (2 k) <= W: no contact of that size holds F with less energy, and W is what the tools
///   have put in since nothing touched the body. Where regions come up at a depth that no motion
///   has brought them to, W is at least k d^2 / 2.
/// - F <= k d, on a body that does not move as a whole. One that does may be dragged against a tool
///   by friction, the more the harder that presses: nothing but energy bounds that.
/// The force of `paper` is a formula of the depth, which stiffens without bound: it is left alone.
void bound_forces(StepContext& context);

}  // namespace torsion
