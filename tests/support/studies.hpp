#pragma once

#include <cstdlib>

namespace torsion::test {

/// Whether tests that look at many cases of a kind look at all of them (`./dev test --all`), or at
/// as many as a run for every change has the time for.
inline bool all_cases() {
  return std::getenv("TORSION_ALL_CASES") != nullptr;
}

}  // namespace torsion::test
