#pragma once

#include <cmath>
#include <numbers>

namespace torsion::engine::reference {

/// Equations (2)-(9) of the paper with one coefficient of friction, summed exactly over a disc:
/// elastic-perfectly plastic torsion of a shaft of radius a and length l under uniform pressure F /
/// (pi a^2).
///   phi <= phi_y = mu F l / (pi G a^3):  T = G pi a^4 phi / (2 l)
///   phi >  phi_y:                        T = (2/3) mu F a (1 - (phi_y / phi)^3 / 4)
/// Exact; derived by integrating r min(G r phi / l, mu p) over the disc.
struct PaperShaft {
  double normal_force;   // F, N
  double friction;       // mu
  double shear_modulus;  // G, Pa
  double radius;         // a, m
  double lever;          // l, m

  [[nodiscard]] double yield_turn() const {
    return friction * normal_force * lever /
           (std::numbers::pi * shear_modulus * std::pow(radius, 3));
  }
  [[nodiscard]] double full_slip_torque() const {
    return 2.0 / 3.0 * friction * normal_force * radius;
  }
  [[nodiscard]] double torque(double turn) const {
    const double size = std::abs(turn);
    const double yield = yield_turn();
    const double value =
        size <= yield
            ? shear_modulus * std::numbers::pi * std::pow(radius, 4) * size / (2.0 * lever)
            : full_slip_torque() * (1.0 - 0.25 * std::pow(yield / size, 3));
    return std::copysign(value, turn);
  }
};

}  // namespace torsion::engine::reference
