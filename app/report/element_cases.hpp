#pragma once

#include <vector>

#include "app/report/reference_case.hpp"

namespace torsion::engine {

/// Finite bodies whose reference is a finite element solution with friction: the same scenes as
/// tests/reference/finite_elements/cases.py, for every case whose results are in the program.
/// @param quick  fewer steps between the points of a path
std::vector<ReferenceCase> element_cases(bool quick);

}  // namespace torsion::engine
