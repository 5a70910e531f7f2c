#pragma once

#include <span>

#include "app/report/plot.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// Draws plots with the program gnuplot, which runs as a process of its own.
/// @return one <svg> element a plot, to be put into one HTML page: names in it are unlike those of
/// the others, and nothing is loaded. Fails where gnuplot is missing or ends with an error.
Result<std::vector<std::string>> draw_plots(std::span<const Plot> plots);

/// Whether plots can be drawn here, tried with a small one. Fails as draw_plots would.
Result<Done> try_gnuplot();

}  // namespace torsion::engine
