#pragma once

#include <vector>

#include "app/report/reference_case.hpp"

namespace torsion::engine {

/// A sphere on a half-space where the answer is known in closed form: pressed and turned to and
/// fro, pushed to and fro, sliding while it spins.
/// @param quick  fewer steps between the points of a path
std::vector<ReferenceCase> exact_cases(bool quick);

}  // namespace torsion::engine
