#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace torsion::engine {

/// Residuals at several points, (points) of (residuals); nullopt where a point has none.
using ResidualsAt = std::function<std::vector<std::optional<Eigen::VectorXd>>(
    std::span<const std::vector<double>> points)>;

/// A coordinate of the search.
struct SearchCoordinate {
  double start = 0.0;
  double least = 0.0;
  double most = 0.0;
  double step = 0.0;  // of the numerical derivative
};

/// Where the sum of the residuals' squares is least.
struct LeastSquares {
  std::vector<double> at;  // (coordinates)
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;  // (residuals) x (coordinates)
  int iterations = 0;
  bool converged = false;
  bool stopped = false;  // because keep_going said so
};

/// Minimizes half the sum of squares within bounds, by the trust-region method of the library Ceres
/// Solver (Levenberg and Marquardt) with central differences, whose points are asked for together.
/// @param keep_going  called after each iteration; false ends the search
/// @return nullopt where there are no residuals at the start
std::optional<LeastSquares> least_squares(const ResidualsAt& residuals_at,
                                          std::span<const SearchCoordinate> coordinates,
                                          const std::function<bool()>& keep_going = {});

}  // namespace torsion::engine
