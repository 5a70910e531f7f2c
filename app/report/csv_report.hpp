#pragma once

#include <span>

#include "app/report/report_data.hpp"

namespace torsion::engine {

/// All runs, one line each, after a header; a field is empty where a case has no such reference.
std::string csv_text(std::span<const MeasuredCase> cases);

}  // namespace torsion::engine
