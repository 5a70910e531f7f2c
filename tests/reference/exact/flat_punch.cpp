#include "tests/reference/exact/flat_punch.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace torsion::engine::reference {

double flat_punch_force(const FlatPunch& punch) {
  return 2.0 * punch.modulus * punch.radius * punch.depth;
}

double flat_punch_pressure(const FlatPunch& punch, double r) {
  const double a = punch.radius;
  if (r > a) {
    return 0.0;
  }
  if (r == a) {
    return std::numeric_limits<double>::infinity();
  }
  return punch.modulus * punch.depth / (std::numbers::pi * std::sqrt((a - r) * (a + r)));
}

double flat_punch_displacement(const FlatPunch& punch, double r) {
  const double inside_angle =
      r <= punch.radius ? 0.5 * std::numbers::pi : std::asin(punch.radius / r);
  return 2.0 * punch.depth / std::numbers::pi * inside_angle;
}

double bonded_punch_ratio(double poisson) {
  assert(poisson >= 0.0 && poisson <= 0.5);
  const double gap = 1.0 - 2.0 * poisson;
  return gap == 0.0 ? 1.0 : (1.0 - poisson) * std::log1p(2.0 * gap) / gap;
}

}  // namespace torsion::engine::reference
