#include "tests/reference/exact/cattaneo_mindlin.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace torsion::engine::reference {

namespace {

/// 1 - (1 - x)^power without cancellation for small x, 0 <= x <= 1.
double one_minus_power(double x, double power) {
  return x >= 1.0 ? 1.0 : -std::expm1(power * std::log1p(-x));
}

}  // namespace

double full_slip_force(const CattaneoMindlin& contact) {
  return contact.friction * contact.normal_force;
}

double tangential_stiffness(const CattaneoMindlin& contact) {
  return 2.0 * contact.tangential_modulus * contact.radius;
}

double full_slip_displacement(const CattaneoMindlin& contact) {
  return 0.75 * full_slip_force(contact) / (contact.tangential_modulus * contact.radius);
}

double tangential_force(const CattaneoMindlin& contact, double displacement) {
  const double share = std::min(std::abs(displacement) / full_slip_displacement(contact), 1.0);
  return std::copysign(full_slip_force(contact) * one_minus_power(share, 1.5), displacement);
}

double tangential_displacement(const CattaneoMindlin& contact, double force) {
  const double share = std::abs(force) / full_slip_force(contact);
  assert(share <= 1.0);
  return std::copysign(full_slip_displacement(contact) * one_minus_power(share, 2.0 / 3.0), force);
}

double tangential_stick_radius(const CattaneoMindlin& contact, double force) {
  const double share = std::abs(force) / full_slip_force(contact);
  assert(share <= 1.0);
  return contact.radius * std::cbrt(1.0 - share);
}

double tangential_traction(const CattaneoMindlin& contact, double force, double r) {
  const double a = contact.radius;
  if (r >= a) {
    return 0.0;
  }
  const double limit =
      1.5 * full_slip_force(contact) / (std::numbers::pi * a * a * a);  // mu p0 / a
  const double c = tangential_stick_radius(contact, force);
  const double inside = r < c ? std::sqrt((c - r) * (c + r)) : 0.0;
  return std::copysign(limit * (std::sqrt((a - r) * (a + r)) - inside), force);
}

double tangential_force_after_turn(const CattaneoMindlin& contact, double turn_displacement,
                                   double displacement) {
  assert(std::abs(displacement) <= std::abs(turn_displacement));
  return tangential_force(contact, turn_displacement) -
         2.0 * tangential_force(contact, 0.5 * (turn_displacement - displacement));
}

double tangential_traction_after_turn(const CattaneoMindlin& contact, double turn_force,
                                      double force, double r) {
  assert(std::abs(force) <= std::abs(turn_force));
  return tangential_traction(contact, turn_force, r) -
         2.0 * tangential_traction(contact, 0.5 * (turn_force - force), r);
}

double tangential_loss_per_cycle(const CattaneoMindlin& contact, double force_amplitude) {
  const double s = std::abs(force_amplitude) / full_slip_force(contact);
  assert(s <= 1.0);
  // The loop between u_A and -u_A encloses 8 int_0^{u_A} Q du - 4 Q_A u_A. In units of mu F times
  // the displacement of full slip, with (1 - s)^(1/3) = c/a, this is (24/5) (1 - c^5) - 4 s (1 +
  // c^2) after integrating Q du by parts.
  const double unit = full_slip_force(contact) * full_slip_displacement(contact);
  if (s > 0.1) {
    const double c = std::cbrt(1.0 - s);
    return unit * (4.8 * (1.0 - std::pow(c, 5)) - 4.0 * s * (1.0 + c * c));
  }
  // Its series: 8 int Q du - 4 Q u with u(Q) = 1 - (1 - s)^(2/3) = sum b_n s^n gives sum 4 b_n
  // s^(n+1) (n-1)/(n+1).
  double coefficient = 2.0 / 3.0;  // b_1
  double power = s * s;
  double sum = 0.0;
  for (int n = 1; n < 20; ++n) {
    sum += 4.0 * coefficient * power * (n - 1.0) / (n + 1.0);
    coefficient *= (n - 2.0 / 3.0) / (n + 1.0);
    power *= s;
  }
  return unit * sum;
}

}  // namespace torsion::engine::reference
