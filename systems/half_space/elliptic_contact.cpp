#include "systems/half_space/elliptic_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace torsion::engine {

using std::numbers::pi;

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
  const double first = 0.5 * pi / a;
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
    // d ln(B / A) / d ln(b / a) is -1.5 near the circle and approaches -2: every value between them
    // converges.
    axes = std::clamp(axes * std::exp(std::log(found / ratio) / 1.7), 0.01, 1.0);
  }
  return axes;
}

/// Integrals of sin^2, of sin^4 and of 1, over (1 - m sin^2)^(3/2), from 0 to pi / 2.
struct Directions {
  double zeroth = 0.0;
  double square = 0.0;
  double fourth = 0.0;
};

Directions over_directions(double m) {
  if (m < 1e-3) {  // the quotients below lose their digits; to third order in m
    return {pi / 2.0 + m * (3.0 * pi / 8.0 + m * 45.0 * pi / 128.0),
            pi / 4.0 + m * (9.0 * pi / 32.0 + m * 75.0 * pi / 256.0),
            3.0 * pi / 16.0 + m * (15.0 * pi / 64.0 + m * 525.0 * pi / 2048.0)};
  }
  const EllipticIntegrals integrals = elliptic_integrals(m);
  const double zeroth = integrals.second / (1.0 - m);
  const double square = (zeroth - integrals.first) / m;
  return {zeroth, square, (square - (integrals.first - integrals.second) / m) / m};
}

}  // namespace

double bonded_turn_share(double axes, double poisson_ratio) {
  const double nu = poisson_ratio;
  const double square = axes * axes;
  // With a = 1: integrals of R^3 cos^p sin^q over half a turn, R the ellipse's radius, over 2 b^3.
  const Directions d = over_directions(1.0 - square);
  const double along = (1.0 - nu) * d.square + nu * d.fourth;
  const double across =
      (1.0 - nu) * (d.zeroth - d.square) + nu * (d.zeroth - 2.0 * d.square + d.fourth);
  const double mixed = nu * (d.square - d.fourth);
  // A (along) + B (mixed / b^2) = A mixed + B (across / b^2) = G phi / b^3
  const double determinant = (along * across - mixed * mixed) / square;
  const double a = (across - mixed) / square / determinant;
  const double b = (along - mixed) / determinant;
  const double couple = 2.0 * pi / 3.0 * axes * (a * square + b);
  return couple / (axes * square) / (16.0 / 3.0 * axes * std::sqrt(axes));
}

EllipseShares ellipse_shares(double axes) {
  const EllipticIntegrals integrals = elliptic_integrals(1.0 - axes * axes);
  const double stretch = 1.0 / std::sqrt(axes);  // a / sqrt(a b)
  return {0.5 * pi / integrals.first * stretch, 2.0 / pi * integrals.second * stretch};
}

EllipticContact elliptic_contact(double depth, double curvature_1, double curvature_2) {
  const double small = 0.5 * std::min(curvature_1, curvature_2);
  const double large = 0.5 * std::max(curvature_1, curvature_2);
  const double axes = large > small * (1.0 + 1e-9) ? axis_ratio(large / small) : 1.0;
  const EllipticIntegrals integrals = elliptic_integrals(1.0 - axes * axes);
  EllipticContact contact;
  // delta = p0 b K / E* and A + B = p0 E / (E* b).
  contact.minor = std::sqrt(depth * integrals.second / (integrals.first * (small + large)));
  contact.major = contact.minor / axes;
  contact.shares = ellipse_shares(axes);
  return contact;
}

}  // namespace torsion::engine
