#pragma once

#include <algorithm>

namespace torsion {

/// 0 up to x = 0, 1 from x = 1, in between the cubic that starts and ends level.
inline double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace torsion
