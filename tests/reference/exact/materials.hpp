#pragma once

namespace torsion::engine::reference {

/// G = E / (2 (1 + nu)), Pa. Exact.
constexpr double shear_modulus(double young, double poisson) {
  return young / (2.0 * (1.0 + poisson));
}

/// E* = E / (1 - nu^2), Pa, of an elastic body under a rigid one. Exact.
/// Source: Johnson, Contact Mechanics, 1985, 4.2.
constexpr double contact_modulus(double young, double poisson) {
  return young / (1.0 - poisson * poisson);
}

/// Gt = 4 G / (2 - nu), Pa, of an elastic body under a rigid one: the tangential stiffness of a
/// circle of radius a is 2 Gt a. Exact. Source: Mindlin, J. Appl. Mech. 16 (1949) 259.
constexpr double tangential_modulus(double young, double poisson) {
  return 4.0 * shear_modulus(young, poisson) / (2.0 - poisson);
}

}  // namespace torsion::engine::reference
