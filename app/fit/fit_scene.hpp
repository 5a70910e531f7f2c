#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/fit/prediction.hpp"
#include "app/fit/uncertainty.hpp"

namespace torsion::engine {

/// What a fit has found for one unknown.
struct Estimate {
  double value = 0.0;
  double low = 0.0;  // of the 95 % interval; -infinity to infinity where the data leave it open
  double high = 0.0;
  bool at_bound = false;  // the search ended at a bound of the value

  [[nodiscard]] bool determined() const;
};

/// How well forces, or torques, are met.
struct Misfit {
  double deviation = 0.0;  // N or N m: root mean square of model minus measurement
  double largest = 0.0;    // N or N m: largest measured
};

struct FitResult {
  std::vector<Estimate> estimates;  // (parameters)
  Eigen::MatrixXd correlation;      // (parameters) x (parameters)
  Prediction prediction;            // with the values found
  Misfit force;
  Misfit torque;
  double correlated_rows = 1.0;  // as in Uncertainty
  int iterations = 0;
  std::uint64_t runs = 0;  // of the scene
  std::vector<std::string> warnings;
};

/// What fit_scene tells while it searches: how many runs of the scene there were. False ends the
/// search.
using FitProgress = std::function<bool(std::uint64_t runs)>;

/// Finds the unknowns with which the model comes nearest to what was measured. Forces and torques
/// are weighted by the deviations that they turn out to have (iteratively reweighted least squares:
/// the likelihood is greatest for normal errors of unknown size). Fails where no value gives a run,
/// where no tool ever touches a body, and where it is stopped.
Result<FitResult> fit_scene(const FitProblem& problem, const FitProgress& progress = {});

}  // namespace torsion::engine
