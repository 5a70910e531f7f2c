#pragma once

#include <Eigen/Core>

namespace torsion {

// Eigen's orthogonal decompositions, compiled once (matrix6.hpp).

/// The x of least |A x - b|, by Householder's reflections; A has full rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// The X of least norm among those of least |A X - B|; A may lack rank.
Eigen::MatrixXd least_norm_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// What least_norm_solution multiplies B by: A's inverse by Moore and Penrose.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

}  // namespace torsion
