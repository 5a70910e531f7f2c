#include "app/report/report_plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

// Colours that stay apart for the colour-blind (Okabe and Ito 2008), in the order of the enum.
constexpr std::array<const char*, 5> kContactColors = {"#000000", "#D55E00", "#0072B2", "#009E73",
                                                       "#CC79A7"};
// gnuplot's numbers of dashes and points, in the order of the enum BodyModel.
constexpr std::array<int, 4> kBodyDashes = {1, 1, 2, 4};
constexpr std::array<int, 4> kBodyPoints = {7, 7, 9, 5};
// Wide below, narrow on top, so that curves that coincide are all seen; in the order of the enum.
constexpr std::array<double, 5> kContactWidths = {1.6, 1.6, 3.6, 1.4, 1.4};
constexpr double kSmallestError = 1e-5;  // below this a logarithmic axis says nothing

/// The model's entry; the last one for a model that is newer than the array.
template <class T, std::size_t n, class Model>
T entry_of(const std::array<T, n>& entries, Model model) {
  return entries[std::min(static_cast<std::size_t>(model), n - 1)];
}

std::string pair_label(const ModelPair& models) {
  return models.body == BodyModel::kNone
             ? std::string(name_of(models.contact))
             : fmt::format("{} + {}", name_of(models.contact), name_of(models.body));
}

/// One point of the speed plot.
struct SpeedPoint {
  ModelPair models;
  double step_us = 0.0;
  double error = 0.0;
};

/// Points that no other beats in both speed and error, by speed.
std::vector<glm::dvec2> pareto_front(std::vector<SpeedPoint> points) {
  std::ranges::sort(points, {}, &SpeedPoint::step_us);
  std::vector<glm::dvec2> front;
  for (const SpeedPoint& point : points) {
    if (front.empty() || 100.0 * point.error < front.back().y) {
      front.emplace_back(point.step_us, 100.0 * point.error);
    }
  }
  return front;
}

Plot plot_of(const std::vector<SpeedPoint>& points) {
  Plot plot;
  plot.x_label = "median of a step (\u00b5s)";
  plot.y_label = "error (%)";
  plot.logarithmic = true;
  PlotSeries front;
  front.label = "Pareto front";
  front.style = PlotSeries::Style::kSteps;
  front.color = "#888888";
  front.dash = 2;
  front.points = pareto_front(points);
  plot.series.push_back(front);
  std::map<std::string, PlotSeries> by_pair;
  for (const SpeedPoint& point : points) {
    PlotSeries& series = by_pair[pair_label(point.models)];
    series.label = pair_label(point.models);
    series.style = PlotSeries::Style::kPoints;
    series.color = entry_of(kContactColors, point.models.contact);
    series.point = entry_of(kBodyPoints, point.models.body);
    series.points.emplace_back(point.step_us, 100.0 * point.error);
    // The front of a patch is told by the sides of its grids; with a body model they repeat.
    if (point.models.contact == ContactModel::kPatch && point.models.body == BodyModel::kNone) {
      series.point_labels.push_back(fmt::format("{0}\u00b2", point.models.grid_side));
    }
  }
  for (const auto& [label, series] : by_pair) {
    plot.series.push_back(series);
  }
  return plot;
}

/// The runs that curves are drawn of: one for each pair of models, patch with the grid that is
/// nearest to the usual one.
std::vector<const MeasuredRun*> drawn_runs(const MeasuredCase& measured) {
  constexpr int kUsualSide = 16;
  std::map<std::pair<ContactModel, BodyModel>, const MeasuredRun*> chosen;
  const auto distance = [](const MeasuredRun& run) {
    return std::abs(static_cast<int>(run.run.models.grid_side) - kUsualSide);
  };
  for (const MeasuredRun& one : measured.runs) {
    const MeasuredRun*& slot = chosen[{one.run.models.contact, one.run.models.body}];
    if (slot == nullptr || distance(one) < distance(*slot)) {
      slot = &one;
    }
  }
  std::vector<const MeasuredRun*> runs;
  runs.reserve(chosen.size());
  for (const auto& [pair, run] : chosen) {
    runs.push_back(run);
  }
  return runs;
}

PlotSeries series_of(const ModelPair& models) {
  PlotSeries series;
  series.label = label_of(models);
  series.color = entry_of(kContactColors, models.contact);
  series.width = entry_of(kContactWidths, models.contact);
  series.dash = entry_of(kBodyDashes, models.body);
  return series;
}

PlotSeries reference_series() {
  PlotSeries series;
  series.label = "reference";
  series.style = PlotSeries::Style::kPoints;
  series.point = 6;  // an open circle
  return series;
}

double value_of(const PathPoint& point, double force, double torque, const PlotAxis& axis) {
  switch (axis.quantity) {
    case PlotAxis::Quantity::kForce:
      return axis.scale * force;
    case PlotAxis::Quantity::kTorque:
      return axis.scale * torque;
    case PlotAxis::Quantity::kAbscissa:
      break;
  }
  return axis.scale * point.abscissa;
}

/// y against x for the legs from the last point before kLoad on.
template <class Takes>
Plot curve_plot(const MeasuredCase& measured, const Takes& takes) {
  const ReferenceCase& one = measured.reference_case;
  Plot plot;
  plot.x_label = one.x.label;
  plot.y_label = one.y.label;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < one.path.size(); ++i) {
    const bool starts = one.connected && one.path[i].leg == Leg::kApproach &&
                        i + 1 < one.path.size() && one.path[i + 1].leg == Leg::kLoad;
    if (starts || (one.path[i].leg != Leg::kApproach && takes(one.path[i].leg))) {
      rows.push_back(i);
    }
  }
  for (const MeasuredRun* run : drawn_runs(measured)) {
    PlotSeries series = series_of(run->run.models);
    series.style = one.connected ? PlotSeries::Style::kLine : PlotSeries::Style::kLineWithPoints;
    for (const std::size_t i : rows) {
      const double force = run->run.forces[i];
      const double torque = run->run.torques[i];
      series.points.emplace_back(value_of(one.path[i], force, torque, one.x),
                                 value_of(one.path[i], force, torque, one.y));
    }
    plot.series.push_back(std::move(series));
  }
  PlotSeries reference = reference_series();
  for (const std::size_t i : rows) {
    const PathPoint& point = one.path[i];
    reference.points.emplace_back(value_of(point, point.force, point.torque, one.x),
                                  value_of(point, point.force, point.torque, one.y));
  }
  plot.series.push_back(std::move(reference));
  return plot;
}

}  // namespace

double worst_error(const CaseErrors& errors) {
  return std::max({errors.force.value_or(0.0), errors.torque.value_or(0.0), kSmallestError});
}

Plot speed_plot(const MeasuredCase& measured) {
  const std::array<const MeasuredCase*, 1> one = {&measured};
  Plot plot = speed_plot(one);
  plot.caption =
      "Speed against error: the median step in contact, and the larger of the errors of force and "
      "torque. Numbers at patch: grid cells of a region.";
  return plot;
}

Plot speed_plot(std::span<const MeasuredCase* const> cases) {
  std::vector<SpeedPoint> points;  // sums of logarithms, then means
  std::vector<double> counts;
  for (const MeasuredCase* measured : cases) {
    for (const MeasuredRun& one : measured->runs) {
      const auto known = std::ranges::find_if(points, [&](const SpeedPoint& point) {
        return label_of(point.models) == label_of(one.run.models);
      });
      const auto row = static_cast<std::size_t>(known - points.begin());
      if (known == points.end()) {
        points.push_back({one.run.models, 0.0, 0.0});
        counts.push_back(0.0);
      }
      points[row].step_us += std::log(one.run.step_us_median);
      points[row].error += std::log(worst_error(one.errors));
      counts[row] += 1.0;
    }
  }
  for (std::size_t row = 0; row < points.size(); ++row) {
    points[row].step_us = std::exp(points[row].step_us / counts[row]);
    points[row].error = std::exp(points[row].error / counts[row]);
  }
  return plot_of(points);
}

Plot loading_plot(const MeasuredCase& measured) {
  Plot plot = curve_plot(measured, [](Leg leg) { return leg == Leg::kLoad; });
  plot.caption = measured.reference_case.connected ? "First loading."
                                                   : "At the end of each ratio of the two motions.";
  return plot;
}

Plot loop_plot(const MeasuredCase& measured) {
  Plot plot = curve_plot(measured, [](Leg) { return true; });
  plot.caption = "Hysteresis: loading, unloading and, where the path has it, reloading.";
  return plot;
}

Plot field_plot(const MeasuredCase& measured) {
  const ReferenceField& field = measured.reference_case.field;
  Plot plot;
  plot.caption = "Twist of the surface over the turn of the tool, at the largest turn.";
  plot.x_label = "radius over the contact\u2019s";
  plot.y_label = "twist over turn of the tool";
  plot.from_zero = true;
  const auto add = [&](PlotSeries series, const std::vector<double>& twists, std::size_t stride) {
    for (std::size_t i = 0; i < field.radii.size(); i += stride) {
      series.points.emplace_back(field.radii[i] / field.contact_radius,
                                 twists[i] / field.tool_turn);
    }
    plot.series.push_back(std::move(series));
  };
  for (const MeasuredRun* run : drawn_runs(measured)) {
    add(series_of(run->run.models), run->run.twists, 1);
  }
  add(reference_series(), field.twists, 2);
  return plot;
}

}  // namespace torsion::engine
