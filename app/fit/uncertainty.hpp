#pragma once

#include <vector>

#include <Eigen/Core>

namespace torsion::engine {

/// How closely data determine the coordinates of a least-squares fit.
struct Uncertainty {
  Eigen::VectorXd sensitivity;  // (coordinates) length of the derivatives; 0: nothing depends on it
  Eigen::VectorXd standard_error;   // (coordinates); infinite where the data leave one open
  Eigen::MatrixXd correlation;      // (coordinates) x (coordinates); 0 where one is left open
  double residual_deviation = 0.0;  // standard deviation of a residual
  double correlated_rows = 1.0;     // how many rows say as much as one alone: 1 for white noise
  double quantile = 1.96;           // standard errors to either side of a 95 % interval
};

/// From the residuals and their derivatives at the minimum: s^2 (J^T J)^-1, where s^2 is the sum of
/// squares over the degrees of freedom; Student's quantile by the expansion of Abramowitz and
/// Stegun, 26.7.5. Residuals that follow each other in time and are alike say less than as many
/// independent ones: variances are multiplied by the integrated autocorrelation time, whose sum
/// ends by Sokal's window (Monte Carlo methods in statistical mechanics, 1997, eq. 3.18).
/// @param rows  residuals of one quantity, in the order of time; the quantities one behind the
/// other
Uncertainty uncertainty_of(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& jacobian,
                           Eigen::Index rows);

}  // namespace torsion::engine
