#pragma once

namespace torsion::engine::reference {

/// Friction force and moment of a rigid body that slides with the velocity v and spins with w on a
/// disc with Hertz's pressure, everything slipping; x = v / (w a). Elementary functions. Source:
/// Contensou 1962; Zhuravlev, J. Appl. Math. Mech. 62 (1998) 705; convexity and normality: Goyal,
/// Ruina and Papadopoulos, Wear 143 (1991) 307.
struct SlidingSpinning {
  double force;   // over mu F, against the velocity
  double moment;  // over mu F a, against the spin
};

/// Largest moment, pure spin, over mu F a: 3 pi / 16.
double pure_spin_moment();

/// @param slide_over_spin x >= 0
/// Error: relative under 1e-13, x = 0 and infinite x included (a series in 1/x^2 from x = 2 on).
SlidingSpinning hertz_limit_surface(double slide_over_spin);

/// Force and moment of a motion, in mu F and mu F a; spin_speed is w a, and both may have any sign.
/// Error: as hertz_limit_surface. 0 and 0 without motion.
SlidingSpinning hertz_limit_surface(double slide_speed, double spin_speed);

/// The moment on the exact surface that goes with a force in [0, 1]; error relative under 1e-12, by
/// bisection.
double hertz_limit_moment(double force);

/// How far out a load lies: the positive factor by which the surface must be scaled to pass through
/// it. 1 on the exact surface, less inside. Error: relative under 1e-12, by bisection. 0 for no
/// load.
double hertz_limit_load(const SlidingSpinning& load);

/// The ellipse force^2 + (moment / (3 pi / 16))^2 = 1, which engines use, at the same motion
/// (normality). The exact surface lies inside it, at worst 6.0 % along the ray. Source: Howe and
/// Cutkosky, Int. J. Robot. Res. 15 (1996) 557.
SlidingSpinning ellipse_limit_surface(double slide_over_spin);

/// sqrt(force^2 + (moment / (3 pi / 16))^2): hertz_limit_load for the ellipse. Exact.
double ellipse_limit_load(const SlidingSpinning& load);

}  // namespace torsion::engine::reference
