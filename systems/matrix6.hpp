#pragma once

#include <Eigen/Core>

namespace torsion {

/// Of forces and couples, or of displacements and rotations.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

}  // namespace torsion
