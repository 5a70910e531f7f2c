#include "app/fit/fit_scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/fit/least_squares.hpp"
#include "systems/contact/region_wrenches.hpp"

namespace torsion::engine {
namespace {

constexpr int kWeightings = 3;
constexpr std::size_t kMostKnown = 64;  // runs that are kept: up to a megabyte each
// Deviations below this share of what was measured are rounding.
constexpr double kLeastDeviation = 1e-7;
constexpr double kHighCorrelation = 0.95;  // if the other is known, one's interval is a third
constexpr double kLargeMisfit = 0.1;       // of the root mean square of what was measured

/// Of forces and of torques.
struct KindScales {
  double force = 1.0;   // N
  double torque = 1.0;  // N m
  [[nodiscard]] double of(const MeasuredQuantity& quantity) const {
    return quantity.is_torque() ? torque : force;
  }
};

/// Root mean squares of forces and of torques; 0 where there are none.
/// @param of  (quantity's row, time's row) to a number
template <class Of>
KindScales root_mean_squares(const Measurement& measurement, const Of& of) {
  double squares[2] = {0.0, 0.0};
  double counts[2] = {0.0, 0.0};
  for (std::size_t q = 0; q < measurement.quantities.size(); ++q) {
    const std::size_t kind = measurement.quantities[q].is_torque() ? 1 : 0;
    for (std::size_t k = 0; k < measurement.times.size(); ++k) {
      const double value = of(q, k);
      squares[kind] += value * value;
      counts[kind] += 1.0;
    }
  }
  return {std::sqrt(squares[0] / std::max(1.0, counts[0])),
          std::sqrt(squares[1] / std::max(1.0, counts[1]))};
}

/// A search for the unknowns of one problem.
class FitSearch {
 public:
  FitSearch(const FitProblem& problem, const FitProgress& progress)
      : problem_(problem), progress_(progress) {
    signal_ = root_mean_squares(problem.measurement, [&](std::size_t q, std::size_t k) {
      return problem.measurement.quantities[q].values[k];
    });
    // Where all of a kind is 0, its unit stands for its size.
    signal_.force = signal_.force > 0.0 ? signal_.force : 1.0;
    signal_.torque = signal_.torque > 0.0 ? signal_.torque : 1.0;
    deviation_ = signal_;
  }

  [[nodiscard]] std::uint64_t runs() const { return runs_; }
  [[nodiscard]] const KindScales& signal() const { return signal_; }
  [[nodiscard]] const KindScales& deviation() const { return deviation_; }

  /// The starts' own values or others, one unknown after the other: the nearest to the measurement.
  /// @return (parameters) in what the search is in; nullopt where no point has a run, or stopped
  std::optional<std::vector<double>> find_start() {
    std::vector<double> best;
    for (const FreeParameter& parameter : problem_.parameters) {
      best.push_back(to_search(parameter, parameter.start));
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < best.size(); ++k) {
      std::vector<std::vector<double>> points = {best};
      for (const double value : problem_.parameters[k].other_starts) {
        points.push_back(best);
        points.back()[k] = to_search(problem_.parameters[k], value);
      }
      const auto found = residuals_at(points);
      for (std::size_t p = 0; p < points.size(); ++p) {
        const double square =
            found[p] ? found[p]->squaredNorm() : std::numeric_limits<double>::infinity();
        if (square < least) {
          least = square;
          best = points[p];
        }
      }
      if (!go_on()) {
        return std::nullopt;
      }
    }
    return std::isfinite(least) ? std::optional(best) : std::nullopt;
  }

  std::optional<LeastSquares> minimize(const std::vector<double>& start) {
    std::vector<SearchCoordinate> coordinates;
    for (std::size_t k = 0; k < start.size(); ++k) {
      const FreeParameter& parameter = problem_.parameters[k];
      coordinates.push_back({start[k], to_search(parameter, parameter.least),
                             to_search(parameter, parameter.most), parameter.step});
    }
    return least_squares(
        [this](std::span<const std::vector<double>> points) { return residuals_at(points); },
        coordinates, [this] { return go_on(); });
  }

  /// Weights by the deviations at a point. @return whether they changed by more than a tenth
  bool weight_by(const Eigen::VectorXd& residuals) {
    const auto times = static_cast<Eigen::Index>(problem_.measurement.times.size());
    KindScales found = root_mean_squares(problem_.measurement, [&](std::size_t q, std::size_t k) {
      return residuals[static_cast<Eigen::Index>(q) * times + static_cast<Eigen::Index>(k)] *
             deviation_.of(problem_.measurement.quantities[q]);
    });
    found.force = std::max(found.force, kLeastDeviation * signal_.force);
    found.torque = std::max(found.torque, kLeastDeviation * signal_.torque);
    const auto changed = [](double before, double now) {
      return std::abs(now - before) > 0.1 * before;
    };
    const bool any =
        changed(deviation_.force, found.force) || changed(deviation_.torque, found.torque);
    deviation_ = found;
    return any;
  }

 private:
  std::vector<std::optional<Eigen::VectorXd>> residuals_at(
      std::span<const std::vector<double>> points) {
    run_unknown(points);
    std::vector<std::optional<Eigen::VectorXd>> residuals;
    for (const std::vector<double>& point : points) {
      const std::optional<Prediction>& known = known_.at(point);
      residuals.push_back(known ? std::optional(residuals_of(*known)) : std::nullopt);
    }
    return residuals;
  }

  /// Runs the scene at those of the points at which it has not been run. Other weights ask for the
  /// same points again.
  void run_unknown(std::span<const std::vector<double>> points) {
    std::vector<std::vector<double>> unknown;
    std::ranges::copy_if(points, std::back_inserter(unknown),
                         [this](const auto& point) { return !known_.contains(point); });
    if (unknown.empty()) {
      return;
    }
    if (known_.size() > kMostKnown) {
      known_.clear();
      unknown.assign(points.begin(), points.end());
    }
    std::vector<std::vector<double>> values;
    for (const std::vector<double>& point : unknown) {
      std::vector<double>& one = values.emplace_back();
      for (std::size_t k = 0; k < point.size(); ++k) {
        one.push_back(from_search(problem_.parameters[k], point[k]));
      }
    }
    runs_ += unknown.size();
    std::vector<std::optional<Prediction>> found = predict_all(problem_, values);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      known_[unknown[k]] = std::move(found[k]);
    }
  }

  [[nodiscard]] Eigen::VectorXd residuals_of(const Prediction& prediction) const {
    const Measurement& measurement = problem_.measurement;
    Eigen::VectorXd residuals(static_cast<Eigen::Index>(measurement.size()));
    std::size_t at = 0;
    for (const MeasuredQuantity& quantity : measurement.quantities) {
      for (const double measured : quantity.values) {
        residuals[static_cast<Eigen::Index>(at)] =
            (prediction.values[at] - measured) / deviation_.of(quantity);
        ++at;
      }
    }
    return residuals;
  }

  [[nodiscard]] bool go_on() const { return !progress_ || progress_(runs_); }

  const FitProblem& problem_;
  const FitProgress& progress_;
  KindScales signal_;     // root mean squares of what was measured
  KindScales deviation_;  // by which residuals are divided
  std::map<std::vector<double>, std::optional<Prediction>> known_;  // by what the search is in
  std::uint64_t runs_ = 0;
};

double largest_of(const Measurement& measurement, bool torque) {
  double largest = 0.0;
  for (const MeasuredQuantity& quantity : measurement.quantities) {
    for (const double value : quantity.values) {
      largest = quantity.is_torque() == torque ? std::max(largest, std::abs(value)) : largest;
    }
  }
  return largest;
}

std::vector<Estimate> estimates_of(const FitProblem& problem, const LeastSquares& found,
                                   const Uncertainty& uncertainty) {
  std::vector<Estimate> estimates;
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const FreeParameter& parameter = problem.parameters[k];
    const double half =
        uncertainty.quantile * uncertainty.standard_error[static_cast<Eigen::Index>(k)];
    Estimate estimate;
    estimate.value = from_search(parameter, found.at[k]);
    const auto bound = [&](double at) {
      return std::clamp(from_search(parameter, at), parameter.least, parameter.most);
    };
    estimate.low = std::isfinite(half) ? bound(found.at[k] - half) : -half;
    estimate.high = std::isfinite(half) ? bound(found.at[k] + half) : half;
    const double margin = 1e-3 * parameter.step;
    estimate.at_bound = found.at[k] <= to_search(parameter, parameter.least) + margin ||
                        found.at[k] >= to_search(parameter, parameter.most) - margin;
    estimates.push_back(estimate);
  }
  return estimates;
}

/// Where one of a body's two coefficients of friction is searched for and the other stays: what was
/// meant may be both.
void warn_of_lone_friction(const FitProblem& problem, std::vector<std::string>& warnings) {
  const auto is_free = [&](const std::string& name) {
    return std::ranges::find(problem.parameters, name, &FreeParameter::name) !=
           problem.parameters.end();
  };
  for (const BodyDescription& body : problem.scene().bodies) {
    const bool dynamic = is_free(body.node + ".dynamic_friction");
    if (dynamic != is_free(body.node + ".static_friction")) {
      warnings.push_back(fmt::format(
          "{}'s {} stayed at {:.6g}; where both are one, as most surfaces have it, free "
          "{}.friction",
          body.node, dynamic ? "static_friction" : "dynamic_friction",
          dynamic ? body.friction.static_friction : body.friction.dynamic_friction, body.node));
    }
  }
}

/// What the data leave open.
void warn_of_open_parameters(const FitProblem& problem, const Uncertainty& uncertainty,
                             std::vector<std::string>& warnings) {
  std::vector<std::string> together;
  const auto n = static_cast<Eigen::Index>(problem.parameters.size());
  for (Eigen::Index a = 0; a < n; ++a) {
    const std::string& name = problem.parameters[static_cast<std::size_t>(a)].name;
    if (uncertainty.sensitivity[a] == 0.0) {
      warnings.push_back(
          fmt::format("nothing that was measured depends on {}: it stays where it was", name));
    } else if (!std::isfinite(uncertainty.standard_error[a])) {
      together.push_back(name);
    }
    for (Eigen::Index b = 0; b < a; ++b) {
      const double correlation = uncertainty.correlation(a, b);
      if (std::abs(correlation) > kHighCorrelation) {
        warnings.push_back(fmt::format(
            "the data hardly tell {} and {} apart (correlation {:.4f}): if one were known, the "
            "other's interval would be {:.1f} times narrower",
            problem.parameters[static_cast<std::size_t>(b)].name, name, correlation,
            1.0 / std::sqrt(1.0 - correlation * correlation)));
      }
    }
  }
  if (!together.empty()) {
    warnings.push_back(
        fmt::format("the data cannot tell {} apart: other values give the same forces. Give one of "
                    "them, or measure a motion in which they act differently",
                    fmt::join(together, ", ")));
  }
}

void warn(const FitProblem& problem, const LeastSquares& found, const Uncertainty& uncertainty,
          const FitSearch& search, FitResult& result) {
  std::vector<std::string>& warnings = result.warnings;
  if (!found.converged) {
    warnings.push_back(
        fmt::format("the search had not settled after {} iterations; start it "
                    "nearer, by --set",
                    found.iterations));
  }
  warn_of_lone_friction(problem, warnings);
  warn_of_open_parameters(problem, uncertainty, warnings);
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    if (result.estimates[k].at_bound) {
      warnings.push_back(fmt::format("{} ended at a bound of its values, {:.6g}",
                                     problem.parameters[k].name, result.estimates[k].value));
    }
  }
  const auto check_kind = [&](const char* kind, double deviation, double signal) {
    if (deviation > kLargeMisfit * signal) {
      warnings.push_back(fmt::format(
          "the {} differ by {:.0f} % of what was measured (root mean square): the scene's shapes, "
          "positions or what holds the body may not be those of the measurement",
          kind, 100.0 * deviation / signal));
    }
  };
  check_kind("forces", result.force.deviation, search.signal().force);
  check_kind("torques", result.torque.deviation, search.signal().torque);
  if (result.prediction.faults != 0) {
    std::string faults = faults_text(result.prediction.faults);
    faults.pop_back();  // the last one's end of line
    warnings.push_back("in the run with these values: " + faults);
  }
}

}  // namespace

bool Estimate::determined() const {
  return std::isfinite(low) && std::isfinite(high);
}

Result<FitResult> fit_scene(const FitProblem& problem, const FitProgress& progress) {
  FitSearch search(problem, progress);
  const Error stopped{problem.scene().path + ": stopped before the fit was done"};
  const std::optional<std::vector<double>> start = search.find_start();
  if (!start) {
    std::vector<double> values;
    for (const FreeParameter& parameter : problem.parameters) {
      values.push_back(parameter.start);
    }
    const Result<Prediction> why = predict(problem, values);
    return why ? stopped : why.error();
  }
  FitResult result;
  std::optional<LeastSquares> found;
  std::vector<double> from = *start;
  for (int weighting = 0; weighting < kWeightings; ++weighting) {
    found = search.minimize(from);
    if (!found || found->stopped) {
      return stopped;
    }
    result.iterations += found->iterations;
    from = found->at;
    if (!search.weight_by(found->residuals)) {
      break;
    }
  }
  std::vector<double> values;
  for (std::size_t k = 0; k < from.size(); ++k) {
    values.push_back(from_search(problem.parameters[k], from[k]));
  }
  Result<Prediction> prediction = predict(problem, values);
  if (!prediction) {
    return prediction.error();
  }
  if (prediction.value().contact_steps == 0) {
    return Error{problem.scene().path +
                 ": no tool touches a body in the measured motion; are its positions in m, in the "
                 "frame of the scene? --column NAME=COLUMN*FACTOR changes units"};
  }
  const auto rows = static_cast<Eigen::Index>(problem.measurement.times.size());
  const Uncertainty uncertainty = uncertainty_of(found->residuals, found->jacobian, rows);
  result.estimates = estimates_of(problem, *found, uncertainty);
  result.correlation = uncertainty.correlation;
  result.correlated_rows = uncertainty.correlated_rows;
  result.prediction = std::move(prediction).value();
  result.force = {search.deviation().force, largest_of(problem.measurement, false)};
  result.torque = {search.deviation().torque, largest_of(problem.measurement, true)};
  result.runs = search.runs() + 1;
  warn(problem, *found, uncertainty, search, result);
  return result;
}

}  // namespace torsion::engine
