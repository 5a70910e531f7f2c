#pragma once

namespace torsion::engine {

/// 0 up to x = 0, 1 from x = 1, in between the cubic that starts and ends level. Without branches
/// or references, so that a loop over it vectorises.
inline double smooth_step(double x) {
  const double above = x > 0.0 ? x : 0.0;
  const double t = above < 1.0 ? above : 1.0;
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace torsion::engine
