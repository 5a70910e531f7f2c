#pragma once

#include <cstdlib>

namespace torsion::engine::test {

/// Whether tests that look at many cases of a kind look at all of them (`./dev test --all`), or at
/// as many as a run for every change has the time for.
inline bool all_cases() {
  return std::getenv("TORSION_ALL_CASES") != nullptr;
}

/// True where a case is left to `./dev test --all`: skip it, so that the run says so.
/// @param chosen  one of the few of its kind that every run looks at
inline bool is_left_out(bool chosen) {
  return !chosen && !all_cases();
}

/// How many of `all` random trials to make: one in `of`, or all of them.
inline int trials_of(int all, int of = 5) {
  return all_cases() ? all : all / of;
}

/// True under sanitizers: they look at memory and races, for which some of many like cases do.
#ifdef TORSION_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

inline constexpr const char* kLeftOut = "one of many of its kind: ./dev test --all looks at it";

}  // namespace torsion::engine::test
