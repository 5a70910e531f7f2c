#pragma once

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace torsion::engine::detail {

/// What a host of the library wants called (include/torsion/types.hpp); null: nothing.
inline std::atomic<void (*)(const char* condition, const char* file, int line)> assertion_handler{
    nullptr};

[[noreturn]] inline void assertion_failed(const char* condition, const char* file, int line) {
  if (const auto handler = assertion_handler.load()) {
    handler(condition, file, line);
  }
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
  std::abort();
}

}  // namespace torsion::engine::detail

// For programmer errors only; bad input gets a Result, an overloaded step a fault bit. On in every
// build type: a wrong row index in a haptic loop is worse than a stopped program.
#define TORSION_ASSERT(condition)     \
  ((condition) ? static_cast<void>(0) \
               : ::torsion::engine::detail::assertion_failed(#condition, __FILE__, __LINE__))
