#include "app/fit/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SVD>

namespace torsion::engine {
namespace {

// Of the derivatives' columns, each of length 1, the least singular value beside the largest below
// which they count as dependent: what numerical derivatives leave open is of a thousandth.
constexpr double kDependent = 1e-3;
constexpr double kPartOfDependence = 0.1;  // of a direction: what a coordinate has in it
constexpr double kWindow = 5.0;            // autocorrelation times that Sokal's sum goes over

/// 97.5 % quantile of Student's distribution.
double student_quantile(double freedom) {
  const double z = 1.959963984540054;
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  return z + (z3 + z) / (4.0 * freedom) +
         (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom);
}

/// How many rows say as much as one alone: the integrated autocorrelation time, at least 1.
double autocorrelation_time(const Eigen::VectorXd& residuals, Eigen::Index rows) {
  const Eigen::Index quantities = residuals.size() / rows;
  const double square = residuals.squaredNorm();
  double time = 1.0;
  for (Eigen::Index lag = 1; lag < rows / 2; ++lag) {
    double product = 0.0;
    for (Eigen::Index q = 0; q < quantities; ++q) {
      const auto of_one = residuals.segment(q * rows, rows);
      product += of_one.head(rows - lag).dot(of_one.tail(rows - lag));
    }
    time += square > 0.0 ? 2.0 * product / square : 0.0;
    if (static_cast<double>(lag) >= kWindow * time) {
      break;
    }
  }
  return std::max(1.0, time);
}

}  // namespace

Uncertainty uncertainty_of(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& jacobian,
                           Eigen::Index rows) {
  const Eigen::Index n = jacobian.cols();
  Uncertainty result;
  const double freedom = std::max(1.0, static_cast<double>(residuals.size() - n));
  const double variance = residuals.squaredNorm() / freedom;
  result.residual_deviation = std::sqrt(variance);
  result.correlated_rows = autocorrelation_time(residuals, rows);
  result.quantile = student_quantile(std::max(1.0, freedom / result.correlated_rows));
  result.standard_error.setConstant(n, std::numeric_limits<double>::infinity());
  result.correlation.setIdentity(n, n);
  const Eigen::VectorXd lengths = jacobian.colwise().norm();
  result.sensitivity = lengths;
  std::vector<Eigen::Index> seen;  // coordinates that change anything
  for (Eigen::Index k = 0; k < n; ++k) {
    if (lengths[k] > 0.0) {
      seen.push_back(k);
    }
  }
  if (seen.empty()) {
    return result;
  }
  const auto count = static_cast<Eigen::Index>(seen.size());
  Eigen::MatrixXd scaled(jacobian.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index column = seen[static_cast<std::size_t>(k)];
    scaled.col(k) = jacobian.col(column) / lengths[column];
  }
  // Of scaled = U S V^T: (scaled^T scaled)^-1 = V S^-2 V^T.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  const Eigen::MatrixXd& directions = svd.matrixV();
  std::vector<bool> open(seen.size(), false);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index d = 0; d < count; ++d) {
    if (singular[d] >= kDependent * singular[0]) {
      inverse += directions.col(d) * directions.col(d).transpose() / (singular[d] * singular[d]);
      continue;
    }
    for (Eigen::Index k = 0; k < count; ++k) {
      open[static_cast<std::size_t>(k)] =
          open[static_cast<std::size_t>(k)] || std::abs(directions(k, d)) > kPartOfDependence;
    }
  }
  for (Eigen::Index a = 0; a < count; ++a) {
    if (open[static_cast<std::size_t>(a)]) {
      continue;
    }
    const Eigen::Index row = seen[static_cast<std::size_t>(a)];
    result.standard_error[row] =
        std::sqrt(variance * result.correlated_rows * inverse(a, a)) / lengths[row];
    for (Eigen::Index b = 0; b < count; ++b) {
      if (!open[static_cast<std::size_t>(b)]) {
        result.correlation(row, seen[static_cast<std::size_t>(b)]) =
            inverse(a, b) / std::sqrt(inverse(a, a) * inverse(b, b));
      }
    }
  }
  return result;
}

}  // namespace torsion::engine
