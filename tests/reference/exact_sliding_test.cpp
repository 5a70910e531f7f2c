#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reference/exact/cattaneo_mindlin.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/limit_surface.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/masing.hpp"
#include "tests/reference/exact/materials.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/exact/torque_limits.hpp"
#include "tests/reference/printed_number.hpp"

namespace torsion::engine::reference {
namespace {

using std::numbers::pi;

CattaneoMindlin slid_rubber() {
  const HertzSphere sphere = hertz_sphere_at_force(0.05, contact_modulus(3e6, 0.5), 10.0);
  return {10.0, 0.75, sphere.radius, tangential_modulus(3e6, 0.5)};
}

TEST(CattaneoMindlinTest, MatchesPrintedValues) {
  const CattaneoMindlin contact = slid_rubber();
  EXPECT_TRUE(rounds_to(tangential_stiffness(contact), 2.422827e4, 7));
  EXPECT_TRUE(rounds_to(full_slip_displacement(contact), 4.64333519e-4, 9));
  const double shares[] = {0.1, 0.5, 0.9, 0.99};
  const double stick[] = {0.96549, 0.79370, 0.46416, 0.21544};
  const double displacements[] = {3.149586e-5, 1.718217e-4, 3.642959e-4, 4.427811e-4};
  for (int i = 0; i < 4; ++i) {
    const double force = shares[i] * full_slip_force(contact);
    EXPECT_TRUE(rounds_to(tangential_stick_radius(contact, force) / contact.radius, stick[i], 5));
    EXPECT_TRUE(rounds_to(tangential_displacement(contact, force), displacements[i], 7));
    EXPECT_NEAR(tangential_force(contact, tangential_displacement(contact, force)) / force, 1.0,
                1e-13);
  }
  EXPECT_EQ(tangential_force(contact, 1.0), full_slip_force(contact));
  EXPECT_EQ(tangential_force(contact, -1.0), -full_slip_force(contact));
}

TEST(CattaneoMindlinTest, TractionCarriesTheForceUnderFriction) {
  const CattaneoMindlin contact = slid_rubber();
  const HertzSphere sphere = hertz_sphere_at_force(0.05, contact_modulus(3e6, 0.5), 10.0);
  for (const double share : {0.2, 0.7, -0.7}) {
    const double force = share * full_slip_force(contact);
    const double c = tangential_stick_radius(contact, force);
    const auto ring = [&](double r, double, double) {
      return 2.0 * pi * r * tangential_traction(contact, force, r);
    };
    const double sum =
        integrate_tanh_sinh(ring, 0.0, c) + integrate_tanh_sinh(ring, c, contact.radius);
    EXPECT_NEAR(sum / force, 1.0, 1e-10) << share;
    const double outside = 0.5 * (c + contact.radius);
    EXPECT_NEAR(std::abs(tangential_traction(contact, force, outside)),
                contact.friction * hertz_pressure(sphere, outside), 1e-9 * sphere.peak_pressure);
    EXPECT_LT(std::abs(tangential_traction(contact, force, 0.9 * c)),
              contact.friction * hertz_pressure(sphere, 0.9 * c));
  }
  // On the way back too: the sum is the force, and nothing exceeds friction.
  const double turn = 0.8 * full_slip_force(contact);
  const double back = tangential_stick_radius(contact, 0.5 * (turn + 0.5 * turn));
  const double before = tangential_stick_radius(contact, turn);
  const auto ring = [&](double r, double, double) {
    return 2.0 * pi * r * tangential_traction_after_turn(contact, turn, -0.5 * turn, r);
  };
  const double sum = integrate_tanh_sinh(ring, 0.0, before) +
                     integrate_tanh_sinh(ring, before, back) +
                     integrate_tanh_sinh(ring, back, contact.radius);
  EXPECT_NEAR(sum / (-0.5 * turn), 1.0, 1e-9);
}

TEST(CattaneoMindlinTest, HistoryOfManyTurnsEqualsSpringsWithFriction) {
  // Dimensionality reduction: springs 2 Gt dx on [0, a] with the limit mu 2 E* (delta - x^2 / R) dx
  // each.
  const CattaneoMindlin contact = slid_rubber();
  const HertzSphere sphere = hertz_sphere_at_force(0.05, contact_modulus(3e6, 0.5), 10.0);
  const Quadrature rule = gauss_legendre(2000, 0.0, contact.radius);
  std::vector<double> stretches(rule.nodes.size(), 0.0);
  MasingHistory history;
  const auto loading = [&](double u) {
    return tangential_force(contact, u);
  };
  double before = 0.0;
  for (const double u : {2e-4, 5e-5, 1.5e-4, 1e-4, 3e-4, -1e-4, -3.5e-4, 6e-4, -6e-4, 0.0}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      const double x = rule.nodes[i];
      const double limit = contact.friction * sphere.modulus * (sphere.depth - x * x / 0.05) /
                           contact.tangential_modulus;
      stretches[i] = std::clamp(stretches[i] + u - before, -limit, limit);
      sum += 2.0 * contact.tangential_modulus * rule.weights[i] * stretches[i];
    }
    before = u;
    // The rule's kink at each stick radius costs 1/count^2 of the force.
    EXPECT_NEAR(move_to(history, loading, u), sum, 1e-6 * full_slip_force(contact)) << u;
  }
  EXPECT_NEAR(tangential_force_after_turn(contact, 3e-4, 1e-4),
              tangential_force(contact, 3e-4) - 2.0 * tangential_force(contact, 1e-4), 1e-15);
}

TEST(CattaneoMindlinTest, LossPerCycleIsTheAreaOfTheLoop) {
  const CattaneoMindlin contact = slid_rubber();
  for (const double share : {0.05, 0.0999, 0.1001, 0.5, 1.0}) {
    const double amplitude = share * full_slip_force(contact);
    const double end = tangential_displacement(contact, amplitude);
    // Half of the loop, between the way back and its mirror image.
    const double area = integrate_tanh_sinh(
        [&](double u, double, double) {
          return -tangential_force_after_turn(contact, end, -u) -
                 tangential_force_after_turn(contact, end, u);
        },
        -end, end);
    EXPECT_NEAR(tangential_loss_per_cycle(contact, amplitude) / area, 1.0, 1e-10) << share;
  }
  // Of small amplitudes the loss is the cube: 4 b_2 s^3 / 3 with u = b_1 s + b_2 s^2, b_2 = 1/9.
  const double tiny = 1e-6;
  const double leading =
      4.0 / 27.0 * std::pow(tiny, 3) * full_slip_force(contact) * full_slip_displacement(contact);
  EXPECT_NEAR(tangential_loss_per_cycle(contact, tiny * full_slip_force(contact)) / leading, 1.0,
              1e-5);
}

TEST(LimitSurfaceTest, MatchesPrintedValues) {
  const double ratios[] = {0.25, 0.5, 1.0, 2.0, 4.0};
  const double forces[] = {0.28992237, 0.55223308, 0.88357293, 0.97427858, 0.99370740};
  const double moments[] = {0.93896484, 0.77343750, 0.37500000, 0.17300666, 0.08526764};
  for (int i = 0; i < 5; ++i) {
    const SlidingSpinning point = hertz_limit_surface(ratios[i]);
    EXPECT_TRUE(rounds_to(point.force, forces[i], 8)) << ratios[i];
    EXPECT_NEAR(point.moment / pure_spin_moment(), moments[i], 0.51e-8) << ratios[i];
  }
}

TEST(LimitSurfaceTest, IsTheIntegralOfFrictionOverTheDisc) {
  // In polar coordinates around the centre of rotation, at the distance x from the middle, the
  // direction of the friction does not depend on the radius, so that the sum over directions
  // converges geometrically.
  for (const double x : {0.0, 0.3, 0.9, 0.999}) {
    double force = 0.0;
    double moment_about_centre = 0.0;
    constexpr int kDirections = 512;
    for (int i = 0; i < kDirections; ++i) {
      const double direction = 2.0 * pi * i / kDirections;
      // Seen from the centre of rotation the middle of the disc is at (0, x).
      const double along = -x * std::sin(direction);
      const double to_rim = -along + std::sqrt(along * along + 1.0 - x * x);
      const auto p = [&](double s) {
        const double gap = 1.0 - x * x - 2.0 * along * s - s * s;
        return 1.5 / pi * std::sqrt(std::max(gap, 0.0));
      };
      force += std::sin(direction) *
               integrate_tanh_sinh([&](double s, double, double) { return s * p(s); }, 0.0, to_rim);
      moment_about_centre +=
          integrate_tanh_sinh([&](double s, double, double) { return s * s * p(s); }, 0.0, to_rim);
    }
    force *= 2.0 * pi / kDirections;
    moment_about_centre *= 2.0 * pi / kDirections;
    const SlidingSpinning point = hertz_limit_surface(x);
    EXPECT_NEAR(point.force, std::abs(force), 1e-6) << x;
    // Moved to the middle: M = M_centre - x F.
    EXPECT_NEAR(point.moment, moment_about_centre - x * std::abs(force), 1e-6) << x;
  }
}

TEST(LimitSurfaceTest, ObeysNormalityEverywhere) {
  // Force and moment are the slopes of one dissipation potential: x dF/dx + dM/dx = 0.
  for (const double x : {0.2, 0.7, 0.99, 1.01, 1.5, 1.99, 2.01, 5.0, 70.0}) {
    const double h = 1e-6 * x;
    const SlidingSpinning more = hertz_limit_surface(x + h);
    const SlidingSpinning less = hertz_limit_surface(x - h);
    const double force_slope = (more.force - less.force) / (2.0 * h);
    const double moment_slope = (more.moment - less.moment) / (2.0 * h);
    EXPECT_NEAR(x * force_slope + moment_slope, 0.0, 1e-9) << x;
    EXPECT_GT(force_slope, 0.0);
  }
}

TEST(LimitSurfaceTest, PiecesMeetAndEndsAreReached) {
  for (const double x : {1.0, 2.0}) {
    const SlidingSpinning below = hertz_limit_surface(x * (1.0 - 1e-15));
    const SlidingSpinning above = hertz_limit_surface(x * (1.0 + 1e-15));
    EXPECT_NEAR(below.force, above.force, 1e-13) << x;
    EXPECT_NEAR(below.moment, above.moment, 1e-13) << x;
  }
  EXPECT_EQ(hertz_limit_surface(0.0).moment, pure_spin_moment());
  EXPECT_EQ(hertz_limit_surface(1.0, 0.0).force, 1.0);
  EXPECT_EQ(hertz_limit_surface(0.0, 0.0).force, 0.0);
  // 1 - 1/(10 x^2) and 16 M0 / (15 pi x) = 1/(5 x), the next terms smaller by x^-2.
  EXPECT_NEAR(hertz_limit_surface(1e4).force, 1.0 - 1e-9, 1e-15);
  EXPECT_NEAR(hertz_limit_surface(1e4).moment, 2e-5, 1e-13);
  const SlidingSpinning mirrored = hertz_limit_surface(-2.0, 1.0);
  EXPECT_EQ(mirrored.force, -hertz_limit_surface(2.0).force);
  EXPECT_EQ(mirrored.moment, hertz_limit_surface(2.0).moment);
}

TEST(LimitSurfaceTest, LiesInsideTheEllipseBySixPercentAtWorst) {
  double worst = 1.0;
  double where = 0.0;
  for (int i = 1; i < 2000; ++i) {
    const double x = 0.002 * i;
    const double radius = ellipse_limit_load(hertz_limit_surface(x));
    EXPECT_LE(radius, 1.0);
    if (radius < worst) {
      worst = radius;
      where = x;
    }
  }
  EXPECT_TRUE(rounds_to(100.0 * (worst - 1.0), -6.0, 2));
  EXPECT_NEAR(where, 0.688, 0.003);  // a flat minimum, searched in steps of 0.002
  for (const double x : {0.0, 0.4, 3.0}) {
    EXPECT_NEAR(ellipse_limit_load(ellipse_limit_surface(x)), 1.0, 1e-15);
  }
}

TEST(LimitSurfaceTest, LoadsAndMomentsInvertTheSurface) {
  for (const double x : {0.01, 0.5, 1.0, 1.7, 3.0, 50.0}) {
    const SlidingSpinning point = hertz_limit_surface(x);
    EXPECT_NEAR(hertz_limit_load({0.4 * point.force, 0.4 * point.moment}), 0.4, 1e-12) << x;
    EXPECT_NEAR(hertz_limit_load({-1.7 * point.force, 1.7 * point.moment}), 1.7, 1e-12) << x;
    // The moment falls by x times the force's rounding.
    EXPECT_NEAR(hertz_limit_moment(point.force), point.moment, 1e-14 * (1.0 + x * x)) << x;
  }
  EXPECT_EQ(hertz_limit_load({0.0, 0.0}), 0.0);
  EXPECT_EQ(hertz_limit_load({0.5, 0.0}), 0.5);
  EXPECT_NEAR(hertz_limit_load({0.0, 0.5}), 0.5 / pure_spin_moment(), 1e-12);
  EXPECT_EQ(hertz_limit_moment(0.0), pure_spin_moment());
  EXPECT_NEAR(hertz_limit_moment(1.0), 0.0, 1e-7);
}

TEST(TorqueLimitsTest, EachIsTheMomentOfItsPressure) {
  for (const TorqueLimit& limit : kTorqueLimits) {
    const LubkinContact contact{limit.shape, 10.0, 0.75, 0.0045, 1e6};
    const double moment = integrate_tanh_sinh(
        [&](double r, double, double) { return 2.0 * pi * r * r * contact_pressure(contact, r); },
        0.0, contact.radius);
    // 1 / sqrt(a - r) of the flat punch from a rounded r: half the digits.
    EXPECT_NEAR(0.75 * moment / (0.75 * 10.0 * 0.0045), limit.factor, 1e-7) << limit.name;
    EXPECT_EQ(saturated_torque(contact), limit.factor * 0.75 * 10.0 * 0.0045);
  }
}

TEST(TorqueLimitsTest, AreToldApartAtThreePercent) {
  // A measured torque with 3 % of error must belong to one limit only: neighbours' bands may not
  // touch.
  for (std::size_t i = 0; i + 1 < kTorqueLimits.size(); ++i) {
    EXPECT_LT(1.03 * kTorqueLimits[i].factor, 0.97 * kTorqueLimits[i + 1].factor)
        << kTorqueLimits[i].name;
  }
}

TEST(TorqueLimitsTest, SpinOfTheLimitSurfaceIsHertzsLimit) {
  EXPECT_EQ(pure_spin_moment(), torque_limit_factor(PressureShape::kHertz));
  EXPECT_NEAR(saturated_torque_ellipse(0.75, 10.0, 0.0045, 0.0),
              torque_limit_factor(PressureShape::kHertz) * 0.75 * 10.0 * 0.0045, 1e-16);
  // Ellipse: mu int p r dA over the stretched disc, by the angle: mean of sqrt(a^2 cos^2 + b^2
  // sin^2) = (2 a / pi) E(m).
  const double m = 0.7;
  double mean = 0.0;
  constexpr int kDirections = 64;
  for (int i = 0; i < kDirections; ++i) {
    const double direction = 2.0 * pi * i / kDirections;
    mean += std::sqrt(1.0 - m * std::pow(std::sin(direction), 2)) / kDirections;
  }
  EXPECT_NEAR(saturated_torque_ellipse(1.0, 1.0, 1.0, m),
              torque_limit_factor(PressureShape::kHertz) * mean, 1e-13);
}

}  // namespace
}  // namespace torsion::engine::reference
