#pragma once

#include <array>
#include <cstddef>
#include <numeric>

#include "systems/math/wide_lanes.hpp"

// TORSION_WIDEST before a function compiles its loops for the widest vectors that the machine has,
// chosen when the program starts. Without fused multiply-add (CMakeLists.txt) all versions give the
// same bits. Sanitizers start too late for the choice. Loops with sums are written in lanes instead
// (wide_lanes.hpp): the compiler makes no vectors of a sum, whose order would change.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TORSION_WIDEST __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TORSION_WIDEST
#endif

namespace torsion::engine {

/// The larger of two numbers, as one instruction (std::max takes references and hinders
/// vectorisation).
inline double larger(double a, double b) {
  return a > b ? a : b;
}

/// What a loop over cells adds up eight at a time: one at a time would wait for the one before.
using Lanes = std::array<double, kLanes>;

/// The largest of all lanes and 0.
inline double largest_of(const Lanes& lanes) {
  double most = 0.0;
  for (const double lane : lanes) {
    most = larger(lane, most);
  }
  return most;
}

inline double sum_of(const Lanes& lanes) {
  return std::accumulate(lanes.begin(), lanes.end(), 0.0);
}

}  // namespace torsion::engine
