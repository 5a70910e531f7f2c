#pragma once

#include "tests/reference/exact/torque_limits.hpp"

namespace torsion::engine::reference {

/// A rigid body pressed with constant force F on a disc of an elastic half-space and turned about
/// its axis, with Coulomb friction: the rim slips, a disc of radius c sticks. Exact for any of the
/// pressures; quasi-static, one half-space (for two bodies put 1 / (1/G1 + 1/G2) for G: the twist
/// is then the sum of both). Everything follows from Reissner-Sagoci discs of radius s, c < s < a,
/// with the weights -H'(s) ds: their traction equals mu p where there is slip (an Abel equation),
/// and their twists add up to phi. Source: Lubkin, J. Appl. Mech. 18 (1951) 183; Deresiewicz, J.
/// Appl. Mech. 21 (1954) 52; Jaeger, Arch. Appl. Mech. 65 (1995) 478 for other pressures.
struct LubkinContact {
  PressureShape shape;
  double normal_force;   // F, N
  double friction;       // mu
  double radius;         // a, m
  double shear_modulus;  // G, Pa
};

/// 2 pi mu int p r^2 dr, N m: torque_limit_factor mu F a. Exact.
double saturated_torque(const LubkinContact& contact);

/// Largest torque of Hertz's ellipse with the major semi-axis a and m = 1 - b^2/a^2: (3/8) mu F a
/// E(m), N m. Error: relative under 1e-14.
double saturated_torque_ellipse(double friction, double normal_force, double major, double m);

/// (16/3) G a^3, N m/rad, before any slip. Exact.
double torsional_stiffness(const LubkinContact& contact);

/// Pressure at the radius r, Pa; 0 outside. Exact.
double contact_pressure(const LubkinContact& contact, double r);

/// H(x) = (mu / 2 G) int_x^a p(r) / sqrt(r^2 - x^2) dr, rad: the twist at which the stick radius is
/// x, 0 < x <= a. Error: closed forms, relative under 1e-13.
double slip_twist(const LubkinContact& contact, double x);

/// -dH/dx, rad/m, 0 < x < a. Error: relative under 1e-13.
double slip_twist_slope(const LubkinContact& contact, double x);

/// c with H(c) = |twist|, m; a where nothing slips; 0 once c/a is under 1e-300.
/// Error: relative under 1e-12, by bisection.
double stick_radius(const LubkinContact& contact, double twist);

/// First loading, odd: T = 16 G int_0^a x^2 min(phi, H(x)) dx, N m.
/// Error: quadrature, relative under 1e-12 (measured against the expansions for small and large
/// twist).
double torque(const LubkinContact& contact, double twist);

/// Masing's rule after a turn at the twist `turn`: T(turn) - 2 T((turn - twist) / 2), |twist| <=
/// |turn|. For other paths: MasingHistory. Error: as torque().
double torque_after_turn(const LubkinContact& contact, double turn, double twist);

/// Work lost to friction over one closed cycle between -amplitude and +amplitude, J: 8 int_0^A T
/// dphi - 4 A T(A), summed as the losses 4 H (A - H) of the slipping rings, which do not cancel.
/// Error: relative under 1e-11.
double torsional_loss_per_cycle(const LubkinContact& contact, double amplitude);

/// Displacement around the axis in first loading, m, at the distance r from the axis and the depth
/// z >= 0. Error: relative under 1e-11, by quadrature over the discs.
double twist_displacement(const LubkinContact& contact, double twist, double r, double z = 0.0);

/// The same after a turn at the twist `turn`, |twist| <= |turn|.
double twist_displacement_after_turn(const LubkinContact& contact, double turn, double twist,
                                     double r, double z = 0.0);

/// Traction around the axis in first loading, Pa: (4 G r / pi) int -H'(s) / sqrt(s^2 - r^2) ds
/// inside the stick radius, mu p outside it. Error: relative under 1e-10.
double twist_traction(const LubkinContact& contact, double twist, double r);

}  // namespace torsion::engine::reference
