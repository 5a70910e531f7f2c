#pragma once

#include <cmath>

#include <gtest/gtest.h>

namespace torsion::engine::reference {

/// Whether `value` is the `printed` number at the digits that were printed: within half a unit of
/// the last one, and a hundredth for numbers that fall on the edge.
inline ::testing::AssertionResult rounds_to(double value, double printed, int significant_digits) {
  const double last =
      std::pow(10.0, std::floor(std::log10(std::abs(printed))) - significant_digits + 1);
  if (std::abs(value - printed) <= 0.51 * last) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure()
         << ::testing::PrintToString(value) << " is not " << printed << " at " << significant_digits
         << " digits, off by " << (value - printed) / last << " of the last";
}

}  // namespace torsion::engine::reference
