#include "systems/math/matrix6.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace torsion {

EigenSystem6 eigen_system(const Matrix6& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vector6 solve_ldlt(const Matrix6& symmetric, const Vector6& right) {
  return symmetric.ldlt().solve(right);
}

Vector6 solve_lu(const Matrix6& matrix, const Vector6& right) {
  return matrix.partialPivLu().solve(right);
}

}  // namespace torsion
