#pragma once

namespace torsion::engine::reference {

/// A rigid sphere pressed on an elastic half-space without friction, in Hertz's approximation
/// (paraboloid). Lengths m, moduli Pa, forces N. Source of all: Johnson, Contact Mechanics, 1985,
/// ch. 3 and 4; Popov, 2010, ch. 5. Error: closed forms, relative under 1e-14. The model's own: see
/// sneddon_sphere_at_radius.
struct HertzSphere {
  double sphere_radius;  // R
  double modulus;        // E*, contact_modulus()
  double force;          // F = (4/3) E* sqrt(R) depth^1.5
  double radius;         // a = sqrt(R depth), of the contact
  double depth;          // delta
  double peak_pressure;  // p0 = 3 F / (2 pi a^2)
  double stiffness;      // dF / d delta = 2 E* a, N/m
};

HertzSphere hertz_sphere_at_depth(double sphere_radius, double modulus, double depth);
HertzSphere hertz_sphere_at_force(double sphere_radius, double modulus, double force);

/// p(r) = p0 sqrt(1 - r^2/a^2), Pa; 0 outside.
double hertz_pressure(const HertzSphere& contact, double r);

/// Normal displacement of the surface, into the body, m, inside and outside the contact.
/// Error: relative under 1e-13 for r <= 3 a, growing as (r/a)^2 1e-16 by cancellation up to 30 a
/// and under 1e-12 beyond.
double hertz_surface_displacement(const HertzSphere& contact, double r);

/// Force and depth of a rigid sphere whose shape is not replaced by a paraboloid.
struct SneddonSphere {
  double radius;  // a, of the contact
  double force;
  double depth;
};

/// F = E* [(a^2 + R^2)/2 ln((R+a)/(R-a)) - a R], depth = (a/2) ln((R+a)/(R-a)); 0 < a < R.
/// Error: relative under 1e-13 (a series replaces the cancelling logarithm below a/R = 0.3).
/// Source: Sneddon, Int. J. Eng. Sci. 3 (1965) 47, eq. 6.15.
SneddonSphere sneddon_sphere_at_radius(double sphere_radius, double modulus, double radius);

/// The same for a given depth > 0, by bisection to the last digits of a. Error: relative under
/// 1e-12.
SneddonSphere sneddon_sphere_at_depth(double sphere_radius, double modulus, double depth);

}  // namespace torsion::engine::reference
