#pragma once

#include <optional>

#include "app/report/run_case.hpp"

namespace torsion::engine {

/// How far a run is from its reference; empty where there is none.
struct CaseErrors {
  std::optional<double> force;   // max |F - F_ref| over max |F_ref|, over the path
  std::optional<double> torque;  // likewise
  // Norm of the difference of the surface's twist over that of the reference's twist; both over the
  // surface as far as the field reaches.
  std::optional<double> twist;
};

CaseErrors errors_of(const ReferenceCase& reference_case, const CaseRun& run);

}  // namespace torsion::engine
