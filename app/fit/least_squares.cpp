#include "app/fit/least_squares.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

namespace torsion::engine {
namespace {

constexpr int kMostSearchIterations = 60;
constexpr double kLeastStep = 1e-7;  // relative
// Of the sum of squares, relative: of a hundred thousand residuals a tenth of a standard error.
constexpr double kLeastDecrease = 1e-7;

/// The residuals and their numerical derivatives, as Ceres asks for them.
class NumericalCost final : public ceres::CostFunction {
 public:
  NumericalCost(const ResidualsAt& residuals_at, std::span<const SearchCoordinate> coordinates,
                Eigen::VectorXd at_start)
      : residuals_at_(residuals_at), coordinates_(coordinates), last_(std::move(at_start)) {
    set_num_residuals(static_cast<int>(last_.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(coordinates.size()));
    for (const SearchCoordinate& coordinate : coordinates) {
      last_point_.push_back(coordinate.start);
    }
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::vector<double> point(parameters[0], parameters[0] + coordinates_.size());
    if (!find_residuals(point)) {
      return false;
    }
    Eigen::Map<Eigen::VectorXd>(residuals, last_.size()) = last_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const Eigen::MatrixXd jacobian = derivatives(point);
      if (coordinates_.size() == 1) {  // Ceres has a column then
        Eigen::Map<Eigen::VectorXd>(jacobians[0], last_.size()) = jacobian.col(0);
      } else {
        Eigen::Map<RowMajor>(jacobians[0], jacobian.rows(), jacobian.cols()) = jacobian;
      }
    }
    return true;
  }

  /// @pre there are residuals at `point`, as Evaluate has found
  [[nodiscard]] const Eigen::VectorXd& residuals(const std::vector<double>& point) const {
    find_residuals(point);
    return last_;
  }

  /// Central differences; towards the one side alone where the other is out of bounds.
  [[nodiscard]] Eigen::MatrixXd derivatives(const std::vector<double>& point) const {
    std::vector<std::vector<double>> points;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      for (const double side : {-1.0, 1.0}) {
        std::vector<double>& moved = points.emplace_back(point);
        moved[k] = std::clamp(point[k] + side * coordinates_[k].step, coordinates_[k].least,
                              coordinates_[k].most);
      }
    }
    const std::vector<std::optional<Eigen::VectorXd>> found = residuals_at_(points);
    Eigen::MatrixXd jacobian(last_.size(), static_cast<Eigen::Index>(coordinates_.size()));
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const auto& below = found[2 * k];
      const auto& above = found[2 * k + 1];
      const double from = below ? points[2 * k][k] : point[k];
      const double to = above ? points[2 * k + 1][k] : point[k];
      const Eigen::VectorXd difference = (above ? *above : last_) - (below ? *below : last_);
      jacobian.col(static_cast<Eigen::Index>(k)) = to > from
                                                       ? Eigen::VectorXd(difference / (to - from))
                                                       : Eigen::VectorXd::Zero(last_.size());
    }
    return jacobian;
  }

 private:
  bool find_residuals(const std::vector<double>& point) const {
    if (point == last_point_) {
      return true;
    }
    std::vector<std::optional<Eigen::VectorXd>> found = residuals_at_({&point, 1});
    if (!found[0]) {
      return false;
    }
    last_point_ = point;
    last_ = std::move(*found[0]);
    return true;
  }

  const ResidualsAt& residuals_at_;
  std::span<const SearchCoordinate> coordinates_;
  // Of the point that was asked for last: Ceres asks for the residuals of a step it may take, and
  // then for them again with the derivatives.
  mutable std::vector<double> last_point_;
  mutable Eigen::VectorXd last_;
};

/// Tells the caller of each iteration.
class IterationTeller final : public ceres::IterationCallback {
 public:
  explicit IterationTeller(const std::function<bool()>& keep_going) : keep_going_(keep_going) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*iteration*/) override {
    return !keep_going_ || keep_going_() ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  const std::function<bool()>& keep_going_;
};

}  // namespace

std::optional<LeastSquares> least_squares(const ResidualsAt& residuals_at,
                                          std::span<const SearchCoordinate> coordinates,
                                          const std::function<bool()>& keep_going) {
  LeastSquares result;
  for (const SearchCoordinate& coordinate : coordinates) {
    result.at.push_back(coordinate.start);
  }
  std::vector<std::optional<Eigen::VectorXd>> at_start = residuals_at({&result.at, 1});
  if (!at_start[0]) {
    return std::nullopt;
  }
  NumericalCost cost(residuals_at, coordinates, std::move(*at_start[0]));
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, result.at.data());
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    if (std::isfinite(coordinates[k].least)) {
      problem.SetParameterLowerBound(result.at.data(), static_cast<int>(k), coordinates[k].least);
    }
    if (std::isfinite(coordinates[k].most)) {
      problem.SetParameterUpperBound(result.at.data(), static_cast<int>(k), coordinates[k].most);
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kMostSearchIterations;
  options.parameter_tolerance = kLeastStep;
  options.function_tolerance = kLeastDecrease;
  options.logging_type = ceres::SILENT;
  IterationTeller teller(keep_going);
  options.callbacks.push_back(&teller);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;  // the first is the start
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.stopped = summary.termination_type == ceres::USER_FAILURE;
  result.residuals = cost.residuals(result.at);
  result.jacobian = cost.derivatives(result.at);
  return result;
}

}  // namespace torsion::engine
