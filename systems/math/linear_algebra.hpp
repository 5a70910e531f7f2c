#pragma once

#include <cstddef>

#include <Eigen/Core>
#include <glm/vec3.hpp>

namespace torsion::engine {

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

/// Solves A X = B for a symmetric, positive definite A by Gauss' elimination without exchanges, in
/// place. Takes nothing from the heap; the same bits on every machine.
/// @param upper  n x n, row-major, `stride` apart: the diagonal and what is right of it are read;
///               overwritten
/// @param right  n x width, row-major: B, then X
/// @param least_pivot  taken in place of smaller ones: what is found then solves other equations
/// @return the smallest pivot that there was
double solve_symmetric(std::size_t n, std::size_t stride, double* upper, std::size_t width,
                       double* right, double least_pivot);

/// Solves A x = b for any A by Gauss' elimination with exchanges of rows, in place, likewise. What
/// it finds of a singular A is not finite.
/// @param matrix  n x n, row-major; overwritten
/// @param right   n: b, then x
void solve_general(std::size_t n, double* matrix, double* right);

// Eigen's orthogonal decompositions, compiled once (matrix6.hpp).

/// The x of least |A x - b|, by Householder's reflections; A has full rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// The X of least norm among those of least |A X - B|; A may lack rank.
Eigen::MatrixXd least_norm_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// What least_norm_solution multiplies B by: A's inverse by Moore and Penrose.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

}  // namespace torsion::engine
