#pragma once

namespace torsion::engine::reference {

/// Complete elliptic integrals of one parameter m (the square of the modulus k), and the two
/// differences in which the textbooks' formulas cancel: each is a sum of terms of one sign here, so
/// none loses digits at either end.
struct CompleteElliptic {
  double k;                     // K(m)
  double e;                     // E(m)
  double k_minus_e;             // K - E, ~ (pi/4) m for m -> 0
  double e_minus_complement_k;  // E - (1 - m) K, ~ (pi/4) m for m -> 0
};

/// @param m          parameter, 0 <= m < 1
/// @param complement 1 - m, > 0; given apart because 1 - x^2/a^2 and x^2/a^2 are both known to all
/// digits
/// @return infinite K for complement 0
/// Error: relative under 1e-14 each (measured against the differential equations of K and E in the
/// tests). Source: arithmetic-geometric mean, Abramowitz and Stegun 17.6.
CompleteElliptic complete_elliptic(double m, double complement);

/// K(m), 0 <= m < 1. Error: relative under 1e-14.
double elliptic_k(double m);

/// E(m), 0 <= m <= 1. Error: relative under 1e-14.
double elliptic_e(double m);

}  // namespace torsion::engine::reference
