#include "systems/contact_models/elliptic_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace torsion {

EllipticIntegrals elliptic_integrals(double m) {
  double a = 1.0;
  double b = std::sqrt(1.0 - m);
  double sum = 0.5 * m;
  double power = 0.5;
  for (int k = 0; k < 8 && std::abs(a - b) > 1e-15 * a; ++k) {
    const double c = 0.5 * (a - b);
    b = std::sqrt(a * b);
    a -= c;
    power *= 2.0;
    sum += power * c * c;
  }
  const double first = 0.5 * std::numbers::pi / a;
  return {first, first * (1.0 - sum)};
}

namespace {

/// Ratio B / A >= 1 of the half curvatures that makes an ellipse of parameter m.
double curvature_ratio(double m, const EllipticIntegrals& integrals) {
  if (m < 1e-6) {
    return 1.0 + 0.75 * m;  // the quotient below loses its digits
  }
  return (integrals.second / (1.0 - m) - integrals.first) / (integrals.first - integrals.second);
}

/// Solves for b / a by Newton's method in logarithms, from Greenwood's approximation
/// b / a = (A / B)^(2/3): J. Tribol. 107 (1985) 501.
double axis_ratio(double ratio) {
  double axes = std::pow(ratio, -2.0 / 3.0);
  for (int k = 0; k < 4; ++k) {
    const double m = 1.0 - axes * axes;
    const double found = curvature_ratio(m, elliptic_integrals(m));
    // d ln(B / A) / d ln(b / a) is -1.5 near the circle and falls to -2: any value between
    // converges.
    axes = std::clamp(axes * std::exp(std::log(found / ratio) / 1.7), 0.01, 1.0);
  }
  return axes;
}

}  // namespace

EllipticContact elliptic_contact(double depth, double curvature_1, double curvature_2) {
  const double small = 0.5 * std::min(curvature_1, curvature_2);
  const double large = 0.5 * std::max(curvature_1, curvature_2);
  const double axes = large > small * (1.0 + 1e-9) ? axis_ratio(large / small) : 1.0;
  const EllipticIntegrals integrals = elliptic_integrals(1.0 - axes * axes);
  EllipticContact contact;
  // delta = p0 b K / E* and A + B = p0 E / (E* b).
  contact.minor = std::sqrt(depth * integrals.second / (integrals.first * (small + large)));
  contact.major = contact.minor / axes;
  const double stretch = 1.0 / std::sqrt(axes);  // a / sqrt(a b)
  contact.force_share = 0.5 * std::numbers::pi / integrals.first * stretch;
  contact.torque_share = 2.0 / std::numbers::pi * integrals.second * stretch;
  return contact;
}

}  // namespace torsion
