#include "tests/reference/exact/hertz_ellipse.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "tests/reference/exact/elliptic_integrals.hpp"
#include "tests/reference/exact/quadrature.hpp"

namespace torsion::engine::reference {

namespace {

/// The shape of the ellipse from the ratio of the radii: m, 1 - m and their integrals.
struct EllipseShape {
  double m;
  double complement;
  CompleteElliptic integrals;
};

EllipseShape shape_at(double q) {
  const double m = 1.0 / (1.0 + std::exp(-q));
  const double complement = 1.0 / (1.0 + std::exp(q));
  return {m, complement, complete_elliptic(m, complement)};
}

/// Solves (larger radius / smaller radius) = [E/(1-m) - K] / [K - E], which grows with m from 1 to
/// infinity.
EllipseShape shape_of(double larger_radius, double smaller_radius) {
  assert(smaller_radius > 0.0 && larger_radius >= smaller_radius);
  const double target = larger_radius / smaller_radius;
  if (target == 1.0) {
    return {0.0, 1.0, complete_elliptic(0.0, 1.0)};
  }
  // In q = ln(m / (1 - m)) neither end is crowded. For nearly equal radii the ratio is 1 + (3/4) m.
  double low = -60.0;
  double high = 300.0;
  for (int iteration = 0; iteration < 80; ++iteration) {
    const double middle = 0.5 * (low + high);
    const EllipseShape shape = shape_at(middle);
    const double ratio =
        shape.integrals.e_minus_complement_k / (shape.complement * shape.integrals.k_minus_e);
    (ratio < target ? low : high) = middle;
  }
  return shape_at(0.5 * (low + high));
}

HertzEllipse ellipse_at_major(const EllipseShape& shape, double curvature_sum, double modulus,
                              double major) {
  const double minor = major * std::sqrt(shape.complement);
  // A + B = p0 E(m) / (E* b).
  const double peak = curvature_sum * modulus * minor / shape.integrals.e;
  return {.modulus = modulus,
          .force = 2.0 / 3.0 * std::numbers::pi * major * minor * peak,
          .major = major,
          .minor = minor,
          .parameter = shape.m,
          .peak_pressure = peak,
          .depth = peak * minor * shape.integrals.k / modulus};
}

double curvature_sum_of(double larger_radius, double smaller_radius) {
  return 0.5 / larger_radius + 0.5 / smaller_radius;
}

}  // namespace

HertzEllipse hertz_ellipse_at_force(double larger_radius, double smaller_radius, double modulus,
                                    double force) {
  assert(modulus > 0.0 && force >= 0.0);
  const EllipseShape shape = shape_of(larger_radius, smaller_radius);
  const double sum = curvature_sum_of(larger_radius, smaller_radius);
  const double cube =
      1.5 * force * shape.integrals.e / (std::numbers::pi * modulus * shape.complement * sum);
  return ellipse_at_major(shape, sum, modulus, std::cbrt(cube));
}

HertzEllipse hertz_ellipse_at_depth(double larger_radius, double smaller_radius, double modulus,
                                    double depth) {
  assert(modulus > 0.0 && depth >= 0.0);
  const EllipseShape shape = shape_of(larger_radius, smaller_radius);
  const double sum = curvature_sum_of(larger_radius, smaller_radius);
  // delta = (A + B) b^2 K / E.
  const double minor = std::sqrt(depth * shape.integrals.e / (sum * shape.integrals.k));
  return ellipse_at_major(shape, sum, modulus, minor / std::sqrt(shape.complement));
}

double hertz_ellipse_pressure(const HertzEllipse& contact, double x, double y) {
  const double gap = 1.0 - std::pow(x / contact.major, 2) - std::pow(y / contact.minor, 2);
  return gap > 0.0 ? contact.peak_pressure * std::sqrt(gap) : 0.0;
}

double hertz_ellipse_displacement(const HertzEllipse& contact, double x, double y) {
  const double a2 = contact.major * contact.major;
  const double b2 = contact.minor * contact.minor;
  const double x2 = x * x;
  const double y2 = y * y;
  // u = (p0 a b / 2 E*) int_lambda^inf (1 - x^2/(a^2+w) - y^2/(b^2+w)) dw / sqrt((a^2+w)(b^2+w) w):
  // lambda = 0 inside, else the confocal ellipse through (x, y), the larger root of (a^2+w)(b^2+w)
  // = x^2 (b^2+w) + y^2 (a^2+w).
  const double half_linear = 0.5 * (x2 + y2 - a2 - b2);
  const double constant = x2 * b2 + y2 * a2 - a2 * b2;
  double lambda = 0.0;
  if (constant > 0.0) {
    const double root = std::sqrt(half_linear * half_linear + constant);
    lambda = half_linear > 0.0 ? half_linear + root : constant / (root - half_linear);
  }
  // w = lambda + v, v = scale^2 s^2 / (1 - s)^2 takes the infinite end to s = 1 and the root at v =
  // 0 away. Every sum is multiplied by (1 - s)^2, so that none overflows at that end.
  const double scale = std::sqrt(a2 + lambda);
  const double integral = integrate_tanh_sinh(
      [&](double s, double, double to_one) {
        const double shrink = to_one * to_one;
        const double v = scale * scale * s * s;
        const double aw = (a2 + lambda) * shrink + v;
        const double bw = (b2 + lambda) * shrink + v;
        // The bracket vanishes at w = lambda > 0, from where it grows by v times its slope.
        const double bracket = lambda > 0.0
                                   ? v * (x2 / ((a2 + lambda) * aw) + y2 / ((b2 + lambda) * bw))
                                   : 1.0 - shrink * (x2 / aw + y2 / bw);
        const double root = lambda > 0.0 ? std::sqrt(v / (lambda * shrink + v)) : 1.0;
        return 2.0 * scale * root * bracket / std::sqrt(aw * bw);
      },
      0.0, 1.0);
  return 0.5 * contact.peak_pressure * contact.major * contact.minor / contact.modulus * integral;
}

}  // namespace torsion::engine::reference
