#include "systems/half_space/coupling.hpp"

namespace torsion {

Wrench unit_wrench(int column) {
  Wrench wrench;
  (column < 3 ? wrench.force : wrench.torque)[column % 3] = 1.0;
  return wrench;
}

Matrix6 half_space_response(const Port& to, const Port& from, const Elasticity& elasticity) {
  Matrix6 response;
  for (int column = 0; column < 6; ++column) {
    const MaterialMotion motion =
        half_space_motion(from, elasticity, unit_wrench(column), to.position);
    for (int axis = 0; axis < 3; ++axis) {
      response(axis, column) = motion.displacement[axis];
      response(3 + axis, column) = motion.rotation[axis];
    }
  }
  return response;
}

Matrix6 half_space_coupling(const Port& to, const Port& from, const Elasticity& elasticity) {
  return 0.5 * (half_space_response(to, from, elasticity) +
                half_space_response(from, to, elasticity).transpose());
}

}  // namespace torsion
