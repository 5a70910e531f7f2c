#include "tests/reference/exact/limit_surface.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace torsion::engine::reference {

namespace {

constexpr double kPureSpinMoment = 3.0 * std::numbers::pi / 16.0;

/// x >= 2. With rho = r/a the mean speed is <|x + rho e^{i theta}|> = x sum b_k^2 <rho^2k> x^-2k,
/// b_k = binomial(1/2, k), <rho^2k> the moments of Hertz's pressure. Force and moment are its
/// derivatives by the velocity and by the spin.
SlidingSpinning mostly_sliding(double x) {
  const double inverse_square = 1.0 / (x * x);
  double binomial = 1.0;
  double moment_of_pressure = 1.0;
  double power = 1.0;
  SlidingSpinning sum{1.0, 0.0};
  for (int k = 1; k <= 24; ++k) {
    binomial *= (1.5 - k) / k;
    moment_of_pressure *= k / (k + 1.5);
    power *= inverse_square;
    const double term = binomial * binomial * moment_of_pressure * power;
    sum.force -= (2.0 * k - 1.0) * term;
    sum.moment += 2.0 * k * term * x;
  }
  return sum;
}

}  // namespace

double pure_spin_moment() {
  return kPureSpinMoment;
}

SlidingSpinning hertz_limit_surface(double slide_over_spin) {
  const double x = slide_over_spin;
  assert(x >= 0.0);
  if (std::isinf(x)) {
    return {1.0, 0.0};
  }
  const double x2 = x * x;
  if (x <= 1.0) {
    return {0.375 * std::numbers::pi * x * (1.0 - 0.25 * x2),
            kPureSpinMoment * (1.0 - x2 + 0.375 * x2 * x2)};
  }
  if (x >= 2.0) {
    return mostly_sliding(x);
  }
  const double w = std::sqrt((x - 1.0) * (x + 1.0));
  const double s = std::asin(1.0 / x);
  return {0.75 / x * (x2 * (1.0 - 0.25 * x2) * s + 0.25 * w * (3.0 + w * w)),
          0.75 * ((0.5 - 0.5 * x2 + 0.1875 * x2 * x2) * s + 0.1875 * w * (1.0 - w * w))};
}

SlidingSpinning hertz_limit_surface(double slide_speed, double spin_speed) {
  if (slide_speed == 0.0 && spin_speed == 0.0) {
    return {0.0, 0.0};
  }
  const SlidingSpinning size = hertz_limit_surface(std::abs(slide_speed / spin_speed));
  return {std::copysign(size.force, slide_speed), std::copysign(size.moment, spin_speed)};
}

double hertz_limit_moment(double force) {
  assert(force >= 0.0 && force <= 1.0);
  // In q = x / (1 + x) the whole surface is the interval [0, 1], and the force grows with q.
  double low = 0.0;
  double high = 1.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double middle = 0.5 * (low + high);
    (hertz_limit_surface(middle / (1.0 - middle)).force < force ? low : high) = middle;
  }
  return high == 1.0 ? 0.0 : hertz_limit_surface(high / (1.0 - high)).moment;
}

double hertz_limit_load(const SlidingSpinning& load) {
  const double force = std::abs(load.force);
  const double moment = std::abs(load.moment);
  if (moment == 0.0) {
    return force;
  }
  // The point of the surface on the ray of the load: force / moment grows with q from 0 to
  // infinity.
  double low = 0.0;
  double high = 1.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double middle = 0.5 * (low + high);
    const SlidingSpinning point = hertz_limit_surface(middle / (1.0 - middle));
    (point.force * moment < point.moment * force ? low : high) = middle;
  }
  const SlidingSpinning point =
      high == 1.0 ? SlidingSpinning{1.0, 0.0} : hertz_limit_surface(high / (1.0 - high));
  return std::hypot(force, moment) / std::hypot(point.force, point.moment);
}

SlidingSpinning ellipse_limit_surface(double slide_over_spin) {
  assert(slide_over_spin >= 0.0);
  if (std::isinf(slide_over_spin)) {
    return {1.0, 0.0};
  }
  // Normality: the motion (v, w a) is the gradient of force^2 + (moment / M0)^2, so force : moment
  // / M0^2 = x : 1.
  const double ratio = slide_over_spin / kPureSpinMoment;
  const double size = std::hypot(1.0, ratio);
  return {ratio / size, kPureSpinMoment / size};
}

double ellipse_limit_load(const SlidingSpinning& load) {
  return std::hypot(load.force, load.moment / kPureSpinMoment);
}

}  // namespace torsion::engine::reference
