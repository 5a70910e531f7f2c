#pragma once

#include <optional>

#include "app/report/run_case.hpp"

namespace torsion {

/// How far a run is from its reference; empty where there is none.
struct CaseErrors {
  std::optional<double> force;   // max |F - F_ref| over max |F_ref|, over the path
  std::optional<double> torque;  // likewise
  std::optional<double> twist;   // root mean square over the radii of the twist's difference, over
                                 // the tool's twist
};

CaseErrors errors_of(const ReferenceCase& reference_case, const CaseRun& run);

}  // namespace torsion
