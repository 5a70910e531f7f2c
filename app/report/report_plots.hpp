#pragma once

#include <span>

#include "app/report/plot.hpp"
#include "app/report/report_data.hpp"

namespace torsion::engine {

/// The larger of the errors in force and torque.
double worst_error(const CaseErrors& errors);

/// Time of a step against worst_error, one point for each run, with the Pareto front.
Plot speed_plot(const MeasuredCase& measured);

/// The same over several cases: geometric means of the medians and of the errors of each choice of
/// models.
Plot speed_plot(std::span<const MeasuredCase* const> cases);

/// What the case is about, first loading only: its y against its x, and the reference.
Plot loading_plot(const MeasuredCase& measured);

/// The same over the whole path.
Plot loop_plot(const MeasuredCase& measured);

/// Twist of the surface over the tool's, against the radius. @pre the case has a field
Plot field_plot(const MeasuredCase& measured);

}  // namespace torsion::engine
