#pragma once

// What wrenches on the surface of a half-space do elsewhere.

#include "ecs/components.hpp"
#include "systems/half_space/fields.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {

/// A unit force along, or torque about, a body axis.
/// @param column  0 to 5: of forces, then of torques
Wrench unit_wrench(int column);

/// Motion at `to` under unit wrenches at `from`, through from's half-space.
Matrix6 half_space_response(const Port& to, const Port& from, const Elasticity& elasticity);

/// Motion (translation, rotation) of the material at `to` under a wrench (force, torque) at `from`
/// as far as half-spaces have it: the mean of the field of from's half-space at `to` and, by
/// reciprocity, of to's at `from`. The two are the same on one plane, and for forces at nu = 0.5.
/// @param to, from  not at one place
Matrix6 half_space_coupling(const Port& to, const Port& from, const Elasticity& elasticity);

}  // namespace torsion
