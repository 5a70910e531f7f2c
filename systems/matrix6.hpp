#pragma once

#include <Eigen/Core>
#include <glm/vec3.hpp>

namespace torsion {

/// Of forces and couples, or of displacements and rotations.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace torsion
