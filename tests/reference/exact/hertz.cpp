#include "tests/reference/exact/hertz.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "tests/reference/exact/stable_differences.hpp"

namespace torsion::engine::reference {

namespace {

HertzSphere hertz_sphere_at_radius(double sphere_radius, double modulus, double radius) {
  const double force = 4.0 / 3.0 * modulus * radius * radius * radius / sphere_radius;
  return {.sphere_radius = sphere_radius,
          .modulus = modulus,
          .force = force,
          .radius = radius,
          .depth = radius * radius / sphere_radius,
          .peak_pressure = 2.0 * modulus * radius / (std::numbers::pi * sphere_radius),
          .stiffness = 2.0 * modulus * radius};
}

}  // namespace

HertzSphere hertz_sphere_at_depth(double sphere_radius, double modulus, double depth) {
  assert(sphere_radius > 0.0 && modulus > 0.0 && depth >= 0.0);
  return hertz_sphere_at_radius(sphere_radius, modulus, std::sqrt(sphere_radius * depth));
}

HertzSphere hertz_sphere_at_force(double sphere_radius, double modulus, double force) {
  assert(sphere_radius > 0.0 && modulus > 0.0 && force >= 0.0);
  return hertz_sphere_at_radius(sphere_radius, modulus,
                                std::cbrt(0.75 * force * sphere_radius / modulus));
}

double hertz_pressure(const HertzSphere& contact, double r) {
  const double a = contact.radius;
  return r < a ? contact.peak_pressure * std::sqrt((1.0 - r / a) * (1.0 + r / a)) : 0.0;
}

double hertz_surface_displacement(const HertzSphere& contact, double r) {
  const double a = contact.radius;
  const double scale = contact.peak_pressure / (2.0 * contact.modulus * a);
  if (r <= a) {
    return 0.5 * std::numbers::pi * scale * (2.0 * a * a - r * r);
  }
  const double t = a / r;
  if (t < 1.0 / 30.0) {
    // (2 t^2 - 1) asin t + t sqrt(1 - t^2) = (4/3) t^3 (1 + t^2/10 + 9 t^4/280 + ...).
    const double t2 = t * t;
    return scale * r * r * 4.0 / 3.0 * t2 * t *
           (1.0 + t2 * (0.1 + t2 * (9.0 / 280.0 + t2 * (5.0 / 336.0 + t2 * 35.0 / 4224.0))));
  }
  return scale * ((2.0 * a * a - r * r) * std::asin(t) + r * a * std::sqrt((1.0 - t) * (1.0 + t)));
}

SneddonSphere sneddon_sphere_at_radius(double sphere_radius, double modulus, double radius) {
  assert(radius > 0.0 && radius < sphere_radius);
  const double t = radius / sphere_radius;
  const double scale = modulus * sphere_radius * sphere_radius;
  const double depth = radius * std::atanh(t);
  return {radius, scale * atanh_difference(t, std::atanh(t)), depth};
}

SneddonSphere sneddon_sphere_at_depth(double sphere_radius, double modulus, double depth) {
  assert(depth > 0.0);
  // In q = atanh(a/R), which has no bound, depth = R q tanh q grows with q.
  const double target = depth / sphere_radius;
  double low = 0.0;
  double high = 1.0;
  while (high * std::tanh(high) < target) {
    high *= 2.0;
  }
  for (int iteration = 0; iteration < 200 && high - low > 1e-16 * high; ++iteration) {
    const double middle = 0.5 * (low + high);
    (middle * std::tanh(middle) < target ? low : high) = middle;
  }
  const double largest = sphere_radius * (1.0 - 1e-16);
  return sneddon_sphere_at_radius(sphere_radius, modulus,
                                  std::min(sphere_radius * std::tanh(high), largest));
}

}  // namespace torsion::engine::reference
