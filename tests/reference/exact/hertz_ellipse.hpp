#pragma once

namespace torsion::engine::reference {

/// A rigid body with two principal radii of curvature pressed on an elastic half-space without
/// friction: the contact is an ellipse. Source of all: Hertz 1882; Johnson, Contact Mechanics,
/// 1985, 4.2 and 3.5(d).
struct HertzEllipse {
  double modulus;        // E*, Pa
  double force;          // F, N
  double major;          // a, m, along the direction of the larger radius of curvature
  double minor;          // b <= a, m
  double parameter;      // m = 1 - b^2/a^2
  double peak_pressure;  // p0 = 3 F / (2 pi a b), Pa
  double depth;          // delta = p0 b K(m) / E*, m
};

/// @param larger_radius, smaller_radius  principal radii of curvature of the body where it touches,
/// m Error: relative under 1e-12 (m by bisection, then closed forms).
HertzEllipse hertz_ellipse_at_force(double larger_radius, double smaller_radius, double modulus,
                                    double force);
HertzEllipse hertz_ellipse_at_depth(double larger_radius, double smaller_radius, double modulus,
                                    double depth);

/// p0 sqrt(1 - x^2/a^2 - y^2/b^2), x along the major semi-axis, Pa; 0 outside.
double hertz_ellipse_pressure(const HertzEllipse& contact, double x, double y);

/// Normal displacement of the surface at (x, y), into the body, m, inside and outside the contact.
/// Error: relative under 1e-11, by quadrature of Johnson's eq. 3.41 with the ellipsoidal coordinate
/// of the place.
double hertz_ellipse_displacement(const HertzEllipse& contact, double x, double y);

}  // namespace torsion::engine::reference
