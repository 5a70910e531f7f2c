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

// Eigen's decompositions of them, compiled once: one takes a compiler seconds, and the longer the
// more there are in a file. None takes anything from the heap.

/// Of a symmetric A = V diag(values) V', values rising.
struct EigenSystem6 {
  Vector6 values;
  Matrix6 vectors;  // V: columns of length 1
};
EigenSystem6 eigen_system(const Matrix6& symmetric);

/// x of A x = b for a symmetric A, definite or nearly so, by L D L'.
Vector6 solve_ldlt(const Matrix6& symmetric, const Vector6& right);

/// x of A x = b for any A, by L U with exchanges of rows. Not finite where A is singular.
Vector6 solve_lu(const Matrix6& matrix, const Vector6& right);

}  // namespace torsion
