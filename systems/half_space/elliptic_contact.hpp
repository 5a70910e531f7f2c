#pragma once

// Hertz' contact of a paraboloid with an elastic half-space from its depth: ellipse and force.

namespace torsion::engine {

/// Complete elliptic integrals of the parameter m, 0 <= m < 1, by the arithmetic-geometric mean;
/// relative error under 1e-14.
struct EllipticIntegrals {
  double first = 0.0;   // K(m)
  double second = 0.0;  // E(m)
};
EllipticIntegrals elliptic_integrals(double m);

/// What an ellipse is over a disc of equal area.
struct EllipseShares {
  // Force over (4/3) E* sqrt(a b) depth, that of a round contact; likewise the normal stiffness of
  // a flat ellipse and, mean over all directions, the compliance of a sliding one (Mindlin, J.
  // Appl. Mech. 16 (1949) 259).
  double force = 1.0;
  double torque = 1.0;  // largest couple over (3 pi / 16) mu F sqrt(a b): from (3/8) mu F a E(m)
};

/// @param axes  b / a, 0 < axes <= 1
EllipseShares ellipse_shares(double axes);

struct EllipticContact {
  double major = 0.0;  // a, m
  double minor = 0.0;  // b, m
  EllipseShares shares;
};

/// Couple over angle of a rigid ellipse bonded to a half-space, over (16/3) G (a b)^(3/2), that of
/// a disc of equal area. Source: tractions q_x = -A y / w, q_y = B x / w with w^2 = 1 - (x/a)^2 -
/// (y/b)^2 turn the ellipse as a whole (Mindlin, 1949); A and B from the integral of Cerruti's
/// solution over all directions.
/// @param axes  b / a, 0 < axes <= 1
double bonded_turn_share(double axes, double poisson_ratio);

/// Contact of the rigid paraboloid z = curvature_1 x^2 / 2 + curvature_2 y^2 / 2 pressed `depth`
/// deep. Axes more than 1 : 100 apart are taken as 1 : 100.
/// Source: Johnson, Contact Mechanics, 1985, 4.2.
/// @param depth                     m, > 0
/// @param curvature_1, curvature_2  1/m, > 0
EllipticContact elliptic_contact(double depth, double curvature_1, double curvature_2);

}  // namespace torsion::engine
