#pragma once

#include "app/report/errors.hpp"

namespace torsion::engine {

/// One line of report.csv.
struct MeasuredRun {
  CaseRun run;
  CaseErrors errors;
};

/// A case with all its runs.
struct MeasuredCase {
  ReferenceCase reference_case;
  std::vector<MeasuredRun> runs;
};

}  // namespace torsion::engine
