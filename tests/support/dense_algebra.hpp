#pragma once

#include <Eigen/Core>

// Eigen's decompositions as tests use them, compiled once and optimized.

namespace torsion::engine::test {

/// Of a symmetric matrix, rising.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric);

/// The lambda of A x = lambda B x, rising: A symmetric, B symmetric and positive definite.
Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix);

/// X of A X = B for a symmetric, positive definite A.
Eigen::MatrixXd solve_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace torsion::engine::test
