#pragma once

#include <array>
#include <cstddef>
#include <numeric>

#include "systems/geometry/distance_shapes.hpp"

namespace torsion {

/// How many cells a loop takes at a time that looks for a largest value: one at a time would wait
/// for the one before. Columns of cells are as long as a multiple of that (Scratch).
inline constexpr std::size_t kLanes = 8;
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

}  // namespace torsion
