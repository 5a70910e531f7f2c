#pragma once

namespace torsion::engine::reference {

/// A Hertz contact (circle) that is pushed sideways at constant normal force, with Coulomb
/// friction: the rim slips, a disc of radius c sticks. Source of all: Cattaneo 1938; Mindlin, J.
/// Appl. Mech. 16 (1949) 259; Mindlin and Deresiewicz, J. Appl. Mech. 20 (1953) 327; Johnson,
/// Contact Mechanics, 1985, 7.2. Error: closed forms, relative under 1e-13. The theory neglects the
/// slip across the direction of the force, which vanishes only for nu = 0; at nu = 0.5 a boundary
/// element solution differs by 0.2 % in the force.
struct CattaneoMindlin {
  double normal_force;        // F, N
  double friction;            // mu
  double radius;              // a, m
  double tangential_modulus;  // Gt, tangential_modulus(), Pa
};

/// mu F, N.
double full_slip_force(const CattaneoMindlin& contact);

/// 2 Gt a, N/m, with no slip.
double tangential_stiffness(const CattaneoMindlin& contact);

/// The displacement at which everything slips, (3/4) mu F / (Gt a), m.
double full_slip_displacement(const CattaneoMindlin& contact);

/// First loading from zero, odd in the displacement: Q = mu F [1 - (1 - u/u_slip)^1.5], |Q| <= mu
/// F.
double tangential_force(const CattaneoMindlin& contact, double displacement);

/// Its inverse, |force| <= mu F.
double tangential_displacement(const CattaneoMindlin& contact, double force);

/// c = a (1 - |Q| / (mu F))^(1/3), m, in first loading to the force Q.
double tangential_stick_radius(const CattaneoMindlin& contact, double force);

/// Traction along the force, Pa, in first loading to the force Q (sign of Q):
/// mu p0 [sqrt(1 - r^2/a^2) - (c/a) sqrt(1 - r^2/c^2)].
double tangential_traction(const CattaneoMindlin& contact, double force, double r);

/// Masing's rule after a turn: force Q(u_turn) - 2 Q((u_turn - u) / 2), while |u| <= |u_turn|.
double tangential_force_after_turn(const CattaneoMindlin& contact, double turn_displacement,
                                   double displacement);

/// Traction on the way back from the force at the turn: the first loading's minus twice that of
/// half the way back.
double tangential_traction_after_turn(const CattaneoMindlin& contact, double turn_force,
                                      double force, double r);

/// Work lost to friction over one closed cycle of the force between -amplitude and +amplitude <= mu
/// F, J. Error: relative under 1e-12 (a series where the closed form of Mindlin and Deresiewicz
/// cancels).
double tangential_loss_per_cycle(const CattaneoMindlin& contact, double force_amplitude);

}  // namespace torsion::engine::reference
