#pragma once

#include <limits>

namespace torsion::engine::test {

// What tests of a tool held through a device have in common.
inline constexpr double kPeriod = 1e-3;                                        // s: a device's
inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();  // of a coupling

}  // namespace torsion::engine::test
