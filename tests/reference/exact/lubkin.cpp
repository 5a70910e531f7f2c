#include "tests/reference/exact/lubkin.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "tests/reference/exact/elliptic_integrals.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/exact/reissner_sagoci.hpp"
#include "tests/reference/exact/stable_differences.hpp"

namespace torsion::engine::reference {

namespace {

/// x^2/a^2 and 1 - x^2/a^2, each with all its digits.
struct RadiusShare {
  double ratio;  // x / a
  double gap;    // 1 - x^2/a^2
};

RadiusShare share_of(const LubkinContact& contact, double x) {
  const double a = contact.radius;
  return {x / a, (a - x) * (a + x) / (a * a)};
}

RadiusShare share_of(const LubkinContact& contact, double x, double to_rim) {
  const double a = contact.radius;
  return {x / a, to_rim * (a + x) / (a * a)};
}

/// mu F / (4 pi G a^2), rad: the slip twist in its natural unit.
double twist_unit(const LubkinContact& contact) {
  return contact.friction * contact.normal_force /
         (4.0 * std::numbers::pi * contact.shear_modulus * contact.radius * contact.radius);
}

/// acosh(1 / ratio) from the gap: asinh(sqrt(gap) / ratio) keeps the digits near the rim.
double area_cosine(const RadiusShare& share) {
  return std::asinh(std::sqrt(share.gap) / share.ratio);
}

/// H over twist_unit. The pressures are F/(pi a^2) times 2 (1-t^2), (3/2) sqrt(1-t^2), 1 and 1/(2
/// sqrt(1-t^2)), t = r/a.
double slip_twist_shape(PressureShape shape, const RadiusShare& share) {
  // Not 0, where K is infinite: the quadratures multiply it by x^2, which has vanished long before.
  const double x2 = std::max(share.ratio * share.ratio, 1e-300);
  switch (shape) {
    case PressureShape::kWinkler:
      // (2 - x^2) acosh(1/x) - sqrt(1 - x^2), and acosh(1/x) = atanh(sqrt(1 - x^2)).
      return 2.0 * atanh_difference(std::sqrt(share.gap), area_cosine(share));
    case PressureShape::kHertz:
      return 3.0 * complete_elliptic(share.gap, x2).k_minus_e;
    case PressureShape::kUniform:
      return 2.0 * area_cosine(share);
    case PressureShape::kFlatPunch:
      return complete_elliptic(share.gap, x2).k;
  }
  return 0.0;
}

/// -a dH/dx over twist_unit.
double slip_twist_slope_shape(PressureShape shape, const RadiusShare& share) {
  const double x = share.ratio;
  switch (shape) {
    case PressureShape::kWinkler:
      return 4.0 * (x * area_cosine(share) + std::sqrt(share.gap) / x);
    case PressureShape::kHertz:
      return 3.0 * complete_elliptic(share.gap, x * x).e / x;
    case PressureShape::kUniform:
      return 2.0 / (x * std::sqrt(share.gap));
    case PressureShape::kFlatPunch:
      return complete_elliptic(share.gap, x * x).e_minus_complement_k / (share.gap * x);
  }
  return 0.0;
}

double slip_twist_slope(const LubkinContact& contact, const RadiusShare& share) {
  return twist_unit(contact) * slip_twist_slope_shape(contact.shape, share) / contact.radius;
}

}  // namespace

double saturated_torque(const LubkinContact& contact) {
  return torque_limit_factor(contact.shape) * contact.friction * contact.normal_force *
         contact.radius;
}

double saturated_torque_ellipse(double friction, double normal_force, double major, double m) {
  return 0.375 * friction * normal_force * major * elliptic_e(m);
}

double torsional_stiffness(const LubkinContact& contact) {
  return bonded_disc_stiffness({contact.radius, contact.shear_modulus, 0.0});
}

double contact_pressure(const LubkinContact& contact, double r) {
  if (r >= contact.radius) {
    return 0.0;
  }
  const double mean = contact.normal_force / (std::numbers::pi * contact.radius * contact.radius);
  const double gap = share_of(contact, r).gap;
  switch (contact.shape) {
    case PressureShape::kWinkler:
      return 2.0 * mean * gap;
    case PressureShape::kHertz:
      return 1.5 * mean * std::sqrt(gap);
    case PressureShape::kUniform:
      return mean;
    case PressureShape::kFlatPunch:
      return 0.5 * mean / std::sqrt(gap);
  }
  return 0.0;
}

double slip_twist(const LubkinContact& contact, double x) {
  assert(x > 0.0 && x <= contact.radius);
  return twist_unit(contact) * slip_twist_shape(contact.shape, share_of(contact, x));
}

double slip_twist_slope(const LubkinContact& contact, double x) {
  assert(x > 0.0 && x < contact.radius);
  return slip_twist_slope(contact, share_of(contact, x));
}

double stick_radius(const LubkinContact& contact, double twist) {
  const double target = std::abs(twist) / twist_unit(contact);
  // In q = ln((1 - x^2/a^2) / (x^2/a^2)) neither end of the radius is crowded and H grows with q.
  const auto share_at = [](double q) {
    const double complement = 1.0 / (1.0 + std::exp(q));
    return RadiusShare{std::sqrt(complement), 1.0 / (1.0 + std::exp(-q))};
  };
  double low = -700.0;
  double high = 700.0;
  if (target <= slip_twist_shape(contact.shape, share_at(low))) {
    return contact.radius;
  }
  if (target >= slip_twist_shape(contact.shape, share_at(high))) {
    return 0.0;
  }
  for (int iteration = 0; iteration < 80; ++iteration) {
    const double middle = 0.5 * (low + high);
    (slip_twist_shape(contact.shape, share_at(middle)) < target ? low : high) = middle;
  }
  return contact.radius * share_at(0.5 * (low + high)).ratio;
}

double torque(const LubkinContact& contact, double twist) {
  const double c = stick_radius(contact, twist);
  const double slipping = integrate_tanh_sinh(
      [&](double x, double, double to_rim) {
        return x * x * slip_twist_shape(contact.shape, share_of(contact, x, to_rim));
      },
      c, contact.radius);
  const double size = 16.0 * contact.shear_modulus *
                      (std::abs(twist) * c * c * c / 3.0 + twist_unit(contact) * slipping);
  return std::copysign(size, twist);
}

double torque_after_turn(const LubkinContact& contact, double turn, double twist) {
  assert(std::abs(twist) <= std::abs(turn));
  return torque(contact, turn) - 2.0 * torque(contact, 0.5 * (turn - twist));
}

double torsional_loss_per_cycle(const LubkinContact& contact, double amplitude) {
  // int_0^A min(phi, H) dphi is A^2/2 where there is no slip and H (A - H/2) elsewhere; the whole
  // of 8 int T - 4 A T(A) is then the sum over slipping rings of 4 H (A - H).
  const double twist = std::abs(amplitude);
  const double slipping = integrate_tanh_sinh(
      [&](double x, double, double to_rim) {
        const double h =
            twist_unit(contact) * slip_twist_shape(contact.shape, share_of(contact, x, to_rim));
        return x * x * 4.0 * h * (twist - h);
      },
      stick_radius(contact, twist), contact.radius);
  return 16.0 * contact.shear_modulus * slipping;
}

double twist_displacement(const LubkinContact& contact, double twist, double r, double z) {
  assert(r >= 0.0 && z >= 0.0);
  if (twist == 0.0) {
    return 0.0;
  }
  const double a = contact.radius;
  const double c = stick_radius(contact, twist);
  const auto discs = [&](double from, double to) {
    return integrate_tanh_sinh(
        [&](double s, double, double to_end) {
          const RadiusShare share = to == a ? share_of(contact, s, to_end) : share_of(contact, s);
          return slip_twist_slope(contact, share) * bonded_disc_twist_ratio(s, r, z);
        },
        from, to);
  };
  // What the rim's own disc bears: all of the twist where nothing slips, else H(a), which only the
  // flat punch has.
  const double rim = c == a ? std::abs(twist) : slip_twist(contact, a);
  double angle = rim * bonded_disc_twist_ratio(a, r, z);
  if (r > c && r < a) {
    angle += discs(c, r) + discs(r, a);  // the field of a disc has a kink where r is its rim
  } else if (c < a) {
    angle += discs(c, a);
  }
  return std::copysign(angle * r, twist);
}

double twist_displacement_after_turn(const LubkinContact& contact, double turn, double twist,
                                     double r, double z) {
  assert(std::abs(twist) <= std::abs(turn));
  return twist_displacement(contact, turn, r, z) -
         2.0 * twist_displacement(contact, 0.5 * (turn - twist), r, z);
}

double twist_traction(const LubkinContact& contact, double twist, double r) {
  assert(r >= 0.0);
  const double a = contact.radius;
  const double c = stick_radius(contact, twist);
  if (r >= a || twist == 0.0) {
    return 0.0;
  }
  if (r >= c) {
    return std::copysign(contact.friction * contact_pressure(contact, r), twist);
  }
  const double rim = c == a ? std::abs(twist) : slip_twist(contact, a);
  double sum = rim / std::sqrt((a - r) * (a + r));
  if (c < a) {
    sum += integrate_tanh_sinh(
        [&](double s, double from_c, double to_rim) {
          const double squares = ((c - r) + from_c) * (s + r);
          return slip_twist_slope(contact, share_of(contact, s, to_rim)) / std::sqrt(squares);
        },
        c, a);
  }
  return std::copysign(4.0 * contact.shear_modulus * r / std::numbers::pi * sum, twist);
}

}  // namespace torsion::engine::reference
