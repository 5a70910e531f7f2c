// What the search of a fit finds, and how closely, against certified values and tables.

#include "app/fit/least_squares.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "app/fit/uncertainty.hpp"

namespace torsion::engine {
namespace {

// NIST's Statistical Reference Datasets, Misra1a: y = b1 (1 - exp(-b2 x)), its first start.
constexpr double kMisraY[] = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                              44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
constexpr double kMisraX[] = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                              378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};

TEST(LeastSquaresTest, FindsWhatNistCertifies) {
  const ResidualsAt residuals = [](std::span<const std::vector<double>> points) {
    std::vector<std::optional<Eigen::VectorXd>> all;
    for (const std::vector<double>& point : points) {
      Eigen::VectorXd one(std::size(kMisraX));
      for (std::size_t k = 0; k < std::size(kMisraX); ++k) {
        one[static_cast<Eigen::Index>(k)] =
            point[0] * (1.0 - std::exp(-point[1] * kMisraX[k])) - kMisraY[k];
      }
      all.emplace_back(one);
    }
    return all;
  };
  const std::vector<SearchCoordinate> start = {{500.0, 0.0, 1e6, 1e-2}, {1e-4, 0.0, 1.0, 1e-8}};
  const std::optional<LeastSquares> found = least_squares(residuals, start);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->converged);
  EXPECT_NEAR(found->at[0], 2.3894212918e2, 1e-4 * 2.4e2);
  EXPECT_NEAR(found->at[1], 5.5015643181e-4, 1e-4 * 5.5e-4);
  EXPECT_NEAR(found->residuals.squaredNorm(), 1.2455138894e-1, 1e-6);
  const Uncertainty uncertainty = uncertainty_of(found->residuals, found->jacobian, 14);
  EXPECT_NEAR(uncertainty.residual_deviation, 1.0187876330e-1, 1e-6);
  const double apart = std::sqrt(uncertainty.correlated_rows);  // NIST takes them as independent
  EXPECT_NEAR(uncertainty.standard_error[0] / apart, 2.7070075241, 1e-3);
  EXPECT_NEAR(uncertainty.standard_error[1] / apart, 7.2668688436e-6, 1e-3 * 7.3e-6);
}

TEST(LeastSquaresTest, StudentsQuantileIsThatOfTables) {
  // Abramowitz and Stegun, table 26.10: 12 and 30 degrees of freedom.
  for (const auto& [freedom, quantile] : {std::pair(12, 2.179), std::pair(30, 2.042)}) {
    const Eigen::Index rows = freedom + 1;
    Eigen::VectorXd residuals(rows);
    for (Eigen::Index k = 0; k < rows; ++k) {
      residuals[k] = k % 2 == 0 ? 1.0 : -1.0;
    }
    const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Ones(rows, 1);
    EXPECT_NEAR(uncertainty_of(residuals, jacobian, rows).quantile, quantile, 2e-3);
  }
}

}  // namespace
}  // namespace torsion::engine
