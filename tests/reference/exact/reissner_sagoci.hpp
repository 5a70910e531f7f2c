#pragma once

namespace torsion::engine::reference {

/// A rigid disc of radius a, bonded to an elastic half-space z >= 0 and turned by the twist phi
/// about its axis. The only displacement is around the axis. Angles rad, lengths m, moduli Pa.
/// Independent of Poisson's ratio. Source of all: Reissner and Sagoci, J. Appl. Phys. 15 (1944)
/// 652; Sneddon, J. Appl. Phys. 18 (1947) 130. Error: closed forms, relative under 1e-13
/// everywhere.
struct BondedDisc {
  double radius;         // a
  double shear_modulus;  // G
  double twist;          // phi
};

/// K0 = T / phi = (16/3) G a^3, N m/rad.
double bonded_disc_stiffness(const BondedDisc& disc);

/// T = (16/3) G a^3 phi, N m.
double bonded_disc_torque(const BondedDisc& disc);

/// Traction around the axis under the disc, (4 G phi / pi) r / sqrt(a^2 - r^2), Pa; infinite at the
/// rim, 0 outside.
double bonded_disc_traction(const BondedDisc& disc, double r);

/// Displacement around the axis at the surface, m.
double bonded_disc_displacement(const BondedDisc& disc, double r);

/// Displacement around the axis at the distance r from it and the depth z >= 0, m.
double bonded_disc_displacement(const BondedDisc& disc, double r, double z);

/// Displacement over (phi r): the twist angle at (r, z), also on the axis, over that of the disc.
double bonded_disc_twist_ratio(double radius, double r, double z);

}  // namespace torsion::engine::reference
