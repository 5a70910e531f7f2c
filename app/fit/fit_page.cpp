#include <algorithm>

#include <fmt/format.h>

#include "app/fit/fit_output.hpp"
#include "app/html_text.hpp"
#include "app/report/gnuplot.hpp"
#include "app/report/html_style.hpp"

namespace torsion::engine {
namespace {

constexpr std::size_t kMostPlotted = 2000;  // points of a curve: more make a page of megabytes

PlotSeries curve_over_time(const Measurement& measurement, const std::string& label,
                           const char* color, double unit, const double* values) {
  PlotSeries series;
  series.label = label;
  series.color = color;
  series.width = 1.2;
  const std::size_t rows = measurement.times.size();
  const std::size_t stride = (rows + kMostPlotted - 1) / kMostPlotted;
  for (std::size_t row = 0; row < rows; row += stride) {
    series.points.emplace_back(measurement.times[row], unit * values[row]);
  }
  return series;
}

/// Two plots a quantity: both curves, and their difference.
std::vector<Plot> fit_plots(const FitProblem& problem, const FitResult& result) {
  const Measurement& measurement = problem.measurement;
  const std::size_t rows = measurement.times.size();
  std::vector<Plot> plots;
  for (std::size_t q = 0; q < measurement.quantities.size(); ++q) {
    const MeasuredQuantity& quantity = measurement.quantities[q];
    const double* const model = result.prediction.values.data() + q * rows;
    const double unit = quantity.is_torque() ? 1e3 : 1.0;
    const std::string label = quantity.is_torque() ? "torque (mN m)" : "force (N)";
    Plot curves;
    curves.caption = quantity.name + ": measured, and as the model has it with the values found.";
    curves.x_label = "time (s)";
    curves.y_label = label;
    curves.series.push_back(
        curve_over_time(measurement, "measured", "#888888", unit, quantity.values.data()));
    curves.series.push_back(curve_over_time(measurement, "model", "#c03020", unit, model));
    Plot difference;
    difference.caption = quantity.name + ": model minus measurement.";
    difference.x_label = curves.x_label;
    difference.y_label = "difference of " + label;
    std::vector<double> differences(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      differences[row] = model[row] - quantity.values[row];
    }
    difference.series.push_back(
        curve_over_time(measurement, "", "#c03020", unit, differences.data()));
    plots.push_back(std::move(curves));
    plots.push_back(std::move(difference));
  }
  return plots;
}

std::string values_table(const FitProblem& problem, const FitResult& result) {
  std::string html =
      "<table><caption>Values found, with 95 % confidence</caption>\n<tr><th></th><th>value</th>"
      "<th>from</th><th>to</th><th>before</th></tr>\n";
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const FreeParameter& parameter = problem.parameters[k];
    const Estimate& estimate = result.estimates[k];
    const auto bound = [&](double value) {
      return estimate.determined() ? fmt::format("{:.4g}", value) : std::string("not determined");
    };
    html += fmt::format(
        "<tr><td>{}{}</td><td>{:.5g}</td><td>{}</td><td>{}</td><td>{:.5g}</td></tr>\n",
        html_escaped(parameter.name), parameter.unit.empty() ? "" : " (" + parameter.unit + ")",
        estimate.value, bound(estimate.low), bound(estimate.high), parameter.start);
  }
  return html + "</table>\n";
}

std::string correlation_table(const FitProblem& problem, const FitResult& result) {
  if (problem.parameters.size() < 2) {
    return "";
  }
  std::string html = "<table><caption>Correlation of the values</caption>\n<tr><th></th>";
  for (const FreeParameter& parameter : problem.parameters) {
    html += "<th>" + html_escaped(parameter.name) + "</th>";
  }
  html += "</tr>\n";
  for (std::size_t a = 0; a < problem.parameters.size(); ++a) {
    html += "<tr><td>" + html_escaped(problem.parameters[a].name) + "</td>";
    for (std::size_t b = 0; b < problem.parameters.size(); ++b) {
      html += fmt::format("<td>{:.3f}</td>", result.correlation(static_cast<Eigen::Index>(a),
                                                                static_cast<Eigen::Index>(b)));
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

Result<std::string> fit_page(const FitProblem& problem, const FitResult& result,
                             const FitFacts& facts) {
  const std::vector<Plot> plots = fit_plots(problem, result);
  const Result<std::vector<std::string>> svgs = draw_plots(plots);
  if (!svgs) {
    return svgs.error();
  }
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Fit of {0}</title>\n"
      "<style>{1}</style></head>\n<body><h1>Fit of {0}</h1>\n",
      html_escaped(problem.scene().path), kReportStyle);
  html += values_table(problem, result) + correlation_table(problem, result);
  for (const std::string& warning : result.warnings) {
    html += "<p><strong>Warning:</strong> " + html_escaped(warning) + "</p>\n";
  }
  html += "<h2>Measured and fitted</h2>\n<div class=\"figures\">\n";
  for (std::size_t k = 0; k < plots.size(); ++k) {
    html += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svgs.value()[k],
                        html_escaped(plots[k].caption));
  }
  return html + "</div>\n<h2>As text</h2>\n<pre>" + html_escaped(fit_text(problem, result, facts)) +
         "</pre>\n</body></html>\n";
}

}  // namespace torsion::engine
