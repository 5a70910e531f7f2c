#pragma once

// How friction goes over from static to dynamic and back: by paths travelled, not by time, so that
// the outcome does not depend on the step.

namespace torsion {

/// A cell that slips comes down from mu_s to mu_d over this share of its elastic deflection: short
/// enough to be the paper's switch (4) -> (5) within the accuracy of 200 cells, long enough that
/// the force does not jump.
inline constexpr double kSlipLength = 0.05;

/// (exp(x) - 1) / x to third order in x: the reciprocal of the exponential's series makes a decay
/// that is monotone, within 4e-6 of exp(-x) up to a tenth, and the same bits with every mathematics
/// library.
inline double growth(double x) {
  return 1.0 + x * (0.5 + x * (1.0 / 6.0));
}

/// 1 - exp(-path / scale): approaches 1 as `path` is travelled.
inline double travelled(double path, double inverse_scale) {
  const double x = path * inverse_scale;
  const double grown = x * growth(x);
  return grown / (1.0 + grown);
}

/// 1 / scale, with 1 / 0 so large that any path is the whole way and none is none.
inline double inverse_of(double scale) {
  return scale > 0.0 ? 1.0 / scale : 1e60;
}

}  // namespace torsion
