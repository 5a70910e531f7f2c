#include "app/fit/fit_output.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace torsion::engine {
namespace {

bool has_kind(const Measurement& measurement, bool torque) {
  return std::ranges::any_of(measurement.quantities, [torque](const MeasuredQuantity& quantity) {
    return quantity.is_torque() == torque;
  });
}

std::string misfit_line(const char* kind, const char* unit, const Misfit& misfit) {
  return fmt::format("{} differ by {:.3g} {} (root mean square), {:.2g} % of the largest\n", kind,
                     misfit.deviation, unit,
                     misfit.largest > 0.0 ? 100.0 * misfit.deviation / misfit.largest : 0.0);
}

std::string estimate_line(const FreeParameter& parameter, const Estimate& estimate,
                          std::size_t width) {
  const std::string label =
      parameter.name + (parameter.unit.empty() ? "" : " (" + parameter.unit + ")");
  const std::string interval = estimate.determined()
                                   ? fmt::format("{:>12.6g} {:>12.6g}", estimate.low, estimate.high)
                                   : fmt::format("{:>25}", "not determined");
  return fmt::format("{:<{}} {:>12.6g} {} {:>12.6g}\n", label, width, estimate.value, interval,
                     parameter.start);
}

/// The settings with which the scene is the fitted one; offsets of the measurement are none.
std::vector<std::string> settings_found(const FitProblem& problem, const FitResult& result) {
  std::vector<std::string> settings;
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const std::string& name = problem.parameters[k].name;
    if (name.find(".offset_") == std::string::npos) {
      settings.push_back(fmt::format("{}={:.6g}", name, result.estimates[k].value));
    }
  }
  return settings;
}

}  // namespace

std::string fit_text(const FitProblem& problem, const FitResult& result, const FitFacts& facts) {
  const Measurement& measurement = problem.measurement;
  std::vector<std::string> quantities;
  for (const MeasuredQuantity& quantity : measurement.quantities) {
    quantities.push_back(quantity.name);
  }
  std::string text =
      fmt::format("{}: {} rows over {:.4g} s of {}\n{}\n{} runs, {} iterations, {:.1f} s\n\n",
                  facts.measured, measurement.times.size(),
                  measurement.times.back() - measurement.times.front(), fmt::join(quantities, ", "),
                  fmt::join(problem.models, "\n"), result.runs, result.iterations, facts.seconds);
  std::size_t width = 10;
  for (const FreeParameter& parameter : problem.parameters) {
    width = std::max(width, parameter.name.size() + parameter.unit.size() + 3);
  }
  text +=
      fmt::format("{:<{}} {:>12} {:>25} {:>12}\n", "", width, "value", "95 % from / to", "before");
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    text += estimate_line(problem.parameters[k], result.estimates[k], width);
  }
  text += "\n";
  for (std::size_t a = 0; a < problem.parameters.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      text += fmt::format(
          "correlation of {} and {}: {:.3f}\n", problem.parameters[b].name,
          problem.parameters[a].name,
          result.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
    }
  }
  if (has_kind(measurement, false)) {
    text += misfit_line("forces", "N", result.force);
  }
  if (has_kind(measurement, true)) {
    text += misfit_line("torques", "N m", result.torque);
  }
  if (result.correlated_rows > 1.5) {
    text += fmt::format(
        "differences that follow each other are alike: the intervals count {:.0f} rows as one\n",
        result.correlated_rows);
  }
  for (const std::string& warning : result.warnings) {
    text += "warning: " + warning + "\n";
  }
  const std::vector<std::string> settings = settings_found(problem, result);
  if (!settings.empty()) {
    text += fmt::format("\n--set {}\n", fmt::join(settings, " --set "));
  }
  return text;
}

std::string fit_json(const FitProblem& problem, const FitResult& result, const FitFacts& facts) {
  nlohmann::ordered_json json;
  json["scene"] = problem.scene().path;
  json["measured"] = facts.measured;
  json["models"] = problem.models;
  json["rows"] = problem.measurement.times.size();
  nlohmann::ordered_json& parameters = json["parameters"];
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const Estimate& estimate = result.estimates[k];
    nlohmann::ordered_json& one = parameters[problem.parameters[k].name];
    one["value"] = estimate.value;
    one["determined"] = estimate.determined();
    if (estimate.determined()) {
      one["low"] = estimate.low;
      one["high"] = estimate.high;
    }
    one["unit"] = problem.parameters[k].unit;
    one["before"] = problem.parameters[k].start;
  }
  for (Eigen::Index a = 0; a < result.correlation.rows(); ++a) {
    nlohmann::ordered_json row;
    for (Eigen::Index b = 0; b < result.correlation.cols(); ++b) {
      row.push_back(result.correlation(a, b));
    }
    json["correlation"].push_back(row);
  }
  if (has_kind(problem.measurement, false)) {
    json["force_deviation_N"] = result.force.deviation;
    json["largest_force_N"] = result.force.largest;
  }
  if (has_kind(problem.measurement, true)) {
    json["torque_deviation_Nm"] = result.torque.deviation;
    json["largest_torque_Nm"] = result.torque.largest;
  }
  json["correlated_rows"] = result.correlated_rows;
  json["iterations"] = result.iterations;
  json["runs"] = result.runs;
  json["seconds"] = facts.seconds;
  json["warnings"] = result.warnings;
  json["settings"] = settings_found(problem, result);
  return json.dump(2) + "\n";
}

std::string fit_table(const FitProblem& problem, const FitResult& result) {
  const Measurement& measurement = problem.measurement;
  std::string text = "time_s";
  for (const MeasuredQuantity& quantity : measurement.quantities) {
    text += fmt::format(",{},{}_model", quantity.name, quantity.name);
  }
  text += "\n";
  const std::size_t rows = measurement.times.size();
  for (std::size_t row = 0; row < rows; ++row) {
    text += fmt::format("{:.9g}", measurement.times[row]);
    for (std::size_t q = 0; q < measurement.quantities.size(); ++q) {
      text += fmt::format(",{:.9g},{:.9g}", measurement.quantities[q].values[row],
                          result.prediction.values[q * rows + row]);
    }
    text += "\n";
  }
  return text;
}

}  // namespace torsion::engine
