#pragma once

namespace torsion::engine::reference {

/// Torsion of straight bars by Saint-Venant: free warping, ends far away. J is the torsion
/// constant, m^4; the torque of a bar of the length L, N m, is G J twist / L. Source: Timoshenko
/// and Goodier, Theory of Elasticity, 1970, ch. 10. Error: closed forms and series summed to their
/// last digit, relative under 1e-14.

/// J = pi r^4 / 2.
double circle_torsion_constant(double radius);

/// J of a rectangle, sides in any order; square: 0.14057701 side^4.
double rectangle_torsion_constant(double side, double other_side);

/// G J twist / L, N m.
double bar_torque(double shear_modulus, double torsion_constant, double length, double twist);

/// Largest shear stress, Pa, at the middle of the longer sides; twist_rate in rad/m.
double rectangle_largest_shear(double shear_modulus, double side, double other_side,
                               double twist_rate);

/// Twist of a round cone between the radii of its ends: 2 T L (r1^2 + r1 r2 + r2^2) / (3 pi G r1^3
/// r2^3), rad. For slender cones: sections are taken to turn as those of a cylinder.
double cone_twist(double torque, double shear_modulus, double length, double radius,
                  double other_radius);

}  // namespace torsion::engine::reference
