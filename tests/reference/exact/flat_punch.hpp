#pragma once

namespace torsion::engine::reference {

/// A rigid flat circular punch pressed on an elastic half-space without friction.
/// Source: Boussinesq 1885; Sneddon, Int. J. Eng. Sci. 3 (1965) 47. Error: closed forms, relative
/// under 1e-14.
struct FlatPunch {
  double radius;   // a, m
  double modulus;  // E*, Pa
  double depth;    // d, m
};

/// F = 2 E* a d, N.
double flat_punch_force(const FlatPunch& punch);

/// F / (2 pi a sqrt(a^2 - r^2)), Pa; infinite at the rim, 0 outside.
double flat_punch_pressure(const FlatPunch& punch, double r);

/// Normal displacement of the surface, into the body, m: d inside, (2 d / pi) asin(a / r) outside.
double flat_punch_displacement(const FlatPunch& punch, double r);

/// Stiffness of a bonded punch over that of a frictionless one, (1 - nu) ln(3 - 4 nu) / (1 - 2 nu);
/// 1 for nu = 0.5. Source: Mossakovskii 1954; Spence, Proc. R. Soc. A 305 (1968) 55. Error:
/// relative under 1e-14, 0 <= nu <= 0.5.
double bonded_punch_ratio(double poisson);

}  // namespace torsion::engine::reference
