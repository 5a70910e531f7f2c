#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/report/machine.hpp"
#include "app/report/report_data.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// The report as one page that needs nothing else: plots as SVG in it, pictures as data.
/// @param pictures  (cases) PNG files' bytes; empty where there is no picture
/// Fails where the plots cannot be drawn.
Result<std::string> html_text(std::span<const MeasuredCase> cases,
                              std::span<const std::string> pictures, const Machine& machine);

}  // namespace torsion::engine
