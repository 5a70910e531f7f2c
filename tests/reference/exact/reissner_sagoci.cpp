#include "tests/reference/exact/reissner_sagoci.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace torsion::engine::reference {

namespace {

/// arccot(zeta) - zeta / (1 + zeta^2), zeta >= 0, without the cancellation for large zeta.
double oblate_twist(double zeta) {
  if (zeta < 3.0) {
    return std::atan2(1.0, zeta) - zeta / (1.0 + zeta * zeta);
  }
  // With y = 1/zeta: atan y - y / (1 + y^2) = sum over n >= 1 of (-1)^(n+1) y^(2n+1) 2 n / (2 n +
  // 1).
  const double y2 = 1.0 / (zeta * zeta);
  double power = y2 / zeta;
  double sum = 0.0;
  for (int n = 1; n <= 18; ++n) {
    sum += power * 2.0 * n / (2.0 * n + 1.0);
    power *= -y2;
  }
  return sum;
}

}  // namespace

double bonded_disc_stiffness(const BondedDisc& disc) {
  return 16.0 / 3.0 * disc.shear_modulus * disc.radius * disc.radius * disc.radius;
}

double bonded_disc_torque(const BondedDisc& disc) {
  return bonded_disc_stiffness(disc) * disc.twist;
}

double bonded_disc_traction(const BondedDisc& disc, double r) {
  const double a = disc.radius;
  if (r > a) {
    return 0.0;
  }
  const double scale = 4.0 * disc.shear_modulus * disc.twist / std::numbers::pi;
  return r == a ? scale * std::numeric_limits<double>::infinity()
                : scale * r / std::sqrt((a - r) * (a + r));
}

double bonded_disc_displacement(const BondedDisc& disc, double r) {
  return bonded_disc_displacement(disc, r, 0.0);
}

double bonded_disc_displacement(const BondedDisc& disc, double r, double z) {
  return disc.twist * r * bonded_disc_twist_ratio(disc.radius, r, z);
}

double bonded_disc_twist_ratio(double radius, double r, double z) {
  assert(radius > 0.0 && r >= 0.0 && z >= 0.0);
  // Oblate coordinates: zeta^2 is the larger root of zeta^4 - s zeta^2 - (z/a)^2 = 0, taken in the
  // form that does not cancel for the sign of s. Distances from the rim are formed first, so that s
  // keeps its digits near it.
  const double depth = z / radius;
  const double s = (r - radius) * (r + radius) / (radius * radius) + depth * depth;
  const double root = std::hypot(s, 2.0 * depth);
  const double zeta_squared = s >= 0.0 ? 0.5 * (s + root) : 2.0 * depth * depth / (root - s);
  return 2.0 / std::numbers::pi * oblate_twist(std::sqrt(zeta_squared));
}

}  // namespace torsion::engine::reference
