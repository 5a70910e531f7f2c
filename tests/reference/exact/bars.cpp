#include "tests/reference/exact/bars.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace torsion::engine::reference {

namespace {

using std::numbers::pi;

}  // namespace

double circle_torsion_constant(double radius) {
  return 0.5 * pi * std::pow(radius, 4);
}

double rectangle_torsion_constant(double side, double other_side) {
  const double longer = std::max(side, other_side);
  const double shorter = std::min(side, other_side);
  // sum tanh(n pi a / 2 b) / n^5 over odd n is that of 1 / n^5, 31 zeta(5) / 32, less terms that
  // fall exponentially.
  double sum = 31.0 / 32.0 * std::riemann_zeta(5.0);
  for (int n = 1; n < 30; n += 2) {
    sum -= 2.0 / (std::exp(n * pi * longer / shorter) + 1.0) / std::pow(n, 5);
  }
  const double open = 1.0 - 192.0 / std::pow(pi, 5) * shorter / longer * sum;
  return longer * std::pow(shorter, 3) / 3.0 * open;
}

double bar_torque(double shear_modulus, double torsion_constant, double length, double twist) {
  return shear_modulus * torsion_constant * twist / length;
}

double rectangle_largest_shear(double shear_modulus, double side, double other_side,
                               double twist_rate) {
  const double longer = std::max(side, other_side);
  const double shorter = std::min(side, other_side);
  double sum = 0.0;
  for (int n = 1; n < 30; n += 2) {
    sum += 1.0 / (n * n * std::cosh(0.5 * n * pi * longer / shorter));
  }
  return shear_modulus * twist_rate * shorter * (1.0 - 8.0 / (pi * pi) * sum);
}

double cone_twist(double torque, double shear_modulus, double length, double radius,
                  double other_radius) {
  const double squares = radius * radius + radius * other_radius + other_radius * other_radius;
  return 2.0 * torque * length * squares /
         (3.0 * pi * shear_modulus * std::pow(radius * other_radius, 3));
}

}  // namespace torsion::engine::reference
