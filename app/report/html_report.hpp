#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/report/machine.hpp"
#include "app/report/report_data.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// What is seen of the cases; nothing where this machine cannot draw.
struct ReportViews {
  std::vector<std::string> pictures;  // (cases) PNG files' bytes
  std::vector<std::string> runs;      // (cases) run_page_data()
  std::string run_parts;              // run_page_parts()
};

/// The report as one page that needs nothing else: plots as SVG in it, pictures as data, runs that
/// play in three dimensions. Fails where the plots cannot be drawn.
/// @pre the views have a row for each case
Result<std::string> html_text(std::span<const MeasuredCase> cases, const ReportViews& views,
                              const Machine& machine);

}  // namespace torsion::engine
