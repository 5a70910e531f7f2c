#pragma once

#include <cmath>

namespace torsion::engine::reference {

/// (1 + t^2) atanh(t) - t, ~ (4/3) t^3 for t -> 0, 0 <= t < 1. Needed by Sneddon's sphere (force)
/// and by the pressure of a Winkler foundation (slip twist).
/// @param atanh_t atanh(t), which the caller may know to more digits than t tells near t = 1
/// Error: relative under 1e-14; below t = 0.3 by the series sum of t^(2n+1) 4 n / (4 n^2 - 1).
inline double atanh_difference(double t, double atanh_t) {
  if (t > 0.3) {
    return (1.0 + t * t) * atanh_t - t;
  }
  double sum = 0.0;
  double power = t;
  for (int n = 1; n <= 16; ++n) {
    power *= t * t;
    sum += power * 4.0 * n / (4.0 * n * n - 1.0);
  }
  return sum;
}

}  // namespace torsion::engine::reference
