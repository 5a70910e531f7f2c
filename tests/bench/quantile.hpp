#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace torsion::engine {

/// The value below which a share of the values lies; not a number of none. Sorts some of them.
inline double quantile(std::vector<double>& values, double share) {
  if (values.empty()) {
    return std::nan("");
  }
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace torsion::engine
