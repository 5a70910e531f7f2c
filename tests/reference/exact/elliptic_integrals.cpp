#include "tests/reference/exact/elliptic_integrals.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace torsion::engine::reference {

CompleteElliptic complete_elliptic(double m, double complement) {
  assert(m >= 0.0 && complement >= 0.0 && std::abs(m + complement - 1.0) < 1e-12);
  if (complement == 0.0) {
    const double infinite = std::numeric_limits<double>::infinity();
    return {infinite, 1.0, infinite, 1.0};
  }
  // With c_0^2 = m, c_{n+1} = (a_n - b_n) / 2: E = K (1 - sum 2^(n-1) c_n^2). The difference a_n -
  // b_n is taken as c_n^2 / (a_n + b_n), which does not cancel.
  double a = 1.0;
  double b = std::sqrt(complement);
  double c_squared = m;
  double power = 0.5;
  double tail = 0.0;  // sum over n >= 1
  while (c_squared > 1e-36 * a * a) {
    const double next_a = 0.5 * (a + b);
    const double c = 0.25 * c_squared / next_a;
    b = std::sqrt(a * b);
    a = next_a;
    c_squared = c * c;
    power *= 2.0;
    tail += power * c_squared;
  }
  const double k = 0.5 * std::numbers::pi / a;
  const double sum = 0.5 * m + tail;
  return {k, k * (1.0 - sum), k * sum, k * (0.5 * m - tail)};
}

double elliptic_k(double m) {
  return complete_elliptic(m, 1.0 - m).k;
}

double elliptic_e(double m) {
  return complete_elliptic(m, 1.0 - m).e;
}

}  // namespace torsion::engine::reference
