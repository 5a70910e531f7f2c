#pragma once

// Hertz' contact of a paraboloid with an elastic half-space from its depth: ellipse and force.

namespace torsion {

/// Complete elliptic integrals of the parameter m, 0 <= m < 1, by the arithmetic-geometric mean;
/// relative error under 1e-14.
struct EllipticIntegrals {
  double first = 0.0;   // K(m)
  double second = 0.0;  // E(m)
};
EllipticIntegrals elliptic_integrals(double m);

struct EllipticContact {
  double major = 0.0;        // a, m
  double minor = 0.0;        // b, m
  double force_share = 1.0;  // force over (4/3) E* sqrt(a b) depth, that of a round contact
  double torque_share =
      1.0;  // largest couple over (3 pi / 16) mu F sqrt(a b): from (3/8) mu F a E(m)
};

/// Contact of the rigid paraboloid z = curvature_1 x^2 / 2 + curvature_2 y^2 / 2 pressed `depth`
/// deep. Axes more than 1 : 100 apart are taken as 1 : 100.
/// Source: Johnson, Contact Mechanics, 1985, 4.2.
/// @param depth                     m, > 0
/// @param curvature_1, curvature_2  1/m, > 0
EllipticContact elliptic_contact(double depth, double curvature_1, double curvature_2);

}  // namespace torsion
