#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/masing.hpp"
#include "tests/reference/exact/materials.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/exact/reissner_sagoci.hpp"
#include "tests/reference/printed_number.hpp"
#include "tests/reference/twisted_rubber.hpp"

namespace torsion::engine::reference {
namespace {

using std::numbers::pi;

TEST(ReissnerSagociTest, MatchesPrintedTorquesAndDisplacements) {
  const BondedDisc discs[] = {{0.005, 1e6, 0.01}, {0.01, 2e5, 0.05}};
  const double torques[] = {6.6666667e-3, 5.3333333e-2};
  const double at_rim[] = {2.669374e-5, 2.669374e-4};  // r = 1.1 a
  const double at_two[] = {5.766889e-6, 5.766889e-5};
  const double at_ten[] = {2.128466e-7, 2.128466e-6};
  const double inside[] = {5.741392e-6, 5.741392e-5};  // r = z = a
  for (int i = 0; i < 2; ++i) {
    const double a = discs[i].radius;
    EXPECT_TRUE(rounds_to(bonded_disc_torque(discs[i]), torques[i], 8));
    EXPECT_NEAR(bonded_disc_displacement(discs[i], 0.5 * a), 0.5 * a * discs[i].twist, 1e-18);
    EXPECT_TRUE(rounds_to(bonded_disc_displacement(discs[i], 1.1 * a), at_rim[i], 7));
    EXPECT_TRUE(rounds_to(bonded_disc_displacement(discs[i], 2.0 * a), at_two[i], 7));
    EXPECT_TRUE(rounds_to(bonded_disc_displacement(discs[i], 10.0 * a), at_ten[i], 7));
    EXPECT_TRUE(rounds_to(bonded_disc_displacement(discs[i], a, a), inside[i], 7));
  }
  const BondedDisc small{twisted_rubber().radius, 1e6, 0.01};
  EXPECT_TRUE(rounds_to(bonded_disc_torque(small), 5.0e-3, 8));
  EXPECT_TRUE(rounds_to(bonded_disc_displacement(small, 1.1 * small.radius), 2.425287e-5, 7));
}

TEST(ReissnerSagociTest, TwistOnTheAxisMatchesPrintedValues) {
  const double depths[] = {0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0};
  const double printed[] = {0.694249, 0.450185, 0.181690, 0.040519, 0.013847, 0.003239, 0.000419};
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(bonded_disc_twist_ratio(1.0, 0.0, depths[i]), printed[i], 0.51e-6);
  }
}

TEST(ReissnerSagociTest, FieldIsInEquilibrium) {
  // u'' + u'/r - u/r^2 + d2u/dz2 = 0. Central differences of step h: error h^2 times fourth
  // derivatives of order u.
  const BondedDisc disc{1.0, 1.0, 1.0};
  const double h = 1e-3;
  const auto u = [&](double r, double z) {
    return bonded_disc_displacement(disc, r, z);
  };
  for (const auto& [r, z] : {std::pair{0.5, 0.7}, {1.0, 0.5}, {1.6, 0.3}, {2.5, 2.0}}) {
    const double radial = (u(r + h, z) - 2.0 * u(r, z) + u(r - h, z)) / (h * h) +
                          (u(r + h, z) - u(r - h, z)) / (2.0 * h * r) - u(r, z) / (r * r);
    const double axial = (u(r, z + h) - 2.0 * u(r, z) + u(r, z - h)) / (h * h);
    EXPECT_NEAR(radial + axial, 0.0, 3e-5) << r << " " << z;
  }
}

TEST(ReissnerSagociTest, FieldIsItsHankelIntegral) {
  // u = (4/pi) a^2 phi int_0^inf j1(k a) exp(-k z) J1(k r) dk; at z = a the tail beyond k a = 40 is
  // exp(-40).
  const Quadrature rule = gauss_legendre(200, 0.0, 40.0);
  const BondedDisc disc{1.0, 1.0, 1.0};
  for (const double r : {0.3, 1.0, 2.0, 5.0}) {
    const double integral = integrate(rule, [&](double k) {
      return std::sph_bessel(1, k) * std::exp(-k) * std::cyl_bessel_j(1.0, k * r);
    });
    EXPECT_NEAR(bonded_disc_displacement(disc, r, 1.0), 4.0 / pi * integral, 1e-11) << r;
  }
}

TEST(ReissnerSagociTest, TractionCarriesTheTorqueAndIsTheSlopeOfTheField) {
  const BondedDisc disc{0.01, 2e5, 0.05};
  const double torque = integrate_tanh_sinh(
      [&](double r, double, double to_rim) {
        const double shear =
            4.0 * disc.shear_modulus * disc.twist / pi * r / std::sqrt(to_rim * (disc.radius + r));
        return 2.0 * pi * r * r * shear;
      },
      0.0, disc.radius);
  EXPECT_NEAR(torque / bonded_disc_torque(disc), 1.0, 1e-12);
  for (const double share : {0.2, 0.5, 0.8}) {
    const double r = share * disc.radius;
    // One-sided second-order difference; its error is h^2 u''' / 3, u''' ~ u / (a (1 - share))^3.
    const double h = 1e-4 * disc.radius;
    const double slope =
        (-3.0 * bonded_disc_displacement(disc, r, 0.0) +
         4.0 * bonded_disc_displacement(disc, r, h) - bonded_disc_displacement(disc, r, 2.0 * h)) /
        (2.0 * h);
    EXPECT_NEAR(-disc.shear_modulus * slope / bonded_disc_traction(disc, r), 1.0, 1e-5) << share;
  }
}

TEST(ReissnerSagociTest, FarFieldIsThatOfATorqueAlone) {
  const BondedDisc disc{0.005, 1e6, 0.01};
  const double torque = bonded_disc_torque(disc);
  for (const auto& [r, z] : {std::pair{5.0, 0.0}, {3.0, 4.0}}) {
    const double far = torque * r / (4.0 * pi * disc.shear_modulus * std::pow(std::hypot(r, z), 3));
    // The next term of the field is smaller by (a / distance)^2 = 1e-6.
    EXPECT_NEAR(bonded_disc_displacement(disc, r, z) / far, 1.0, 2e-6);
  }
}

TEST(LubkinTest, MatchesPrintedTorquesAndStickRadii) {
  const double twists[] = {1e-4, 1e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5};
  const double torques[] = {4.99450015e-5, 4.94530324e-4, 4.48220299e-3, 8.05015720e-3,
                            1.47857373e-2, 1.88848661e-2, 2.00252581e-2, 2.00694807e-2};
  const double stick[] = {0.9992664, 0.9926759, 0.9279943, 0.8588246,
                          0.6696088, 0.4198543, 0.1442482};
  const LubkinContact contact = twisted_rubber();
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(rounds_to(torque(contact, twists[i]), torques[i], 9)) << twists[i];
  }
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(stick_radius(contact, twists[i]) / contact.radius, stick[i], 0.51e-7) << twists[i];
  }
  EXPECT_TRUE(rounds_to(stick_radius(contact, 0.5) / contact.radius, 4.623090e-3, 7));
  EXPECT_TRUE(rounds_to(saturated_torque(contact), 2.00694822e-2, 9));
  EXPECT_TRUE(rounds_to(torsional_stiffness(contact), 0.5, 9));
}

TEST(LubkinTest, MatchesPrintedTorquesOfOtherLoads) {
  EXPECT_TRUE(
      rounds_to(torque(twisted_rubber(PressureShape::kHertz, 1.0), 0.01), 3.95948466e-4, 9));
  EXPECT_TRUE(
      rounds_to(torque(twisted_rubber(PressureShape::kHertz, 100.0), 0.1), 3.06399705e-1, 9));
  EXPECT_TRUE(
      rounds_to(torque(twisted_rubber(PressureShape::kHertz, 10.0, 0.3), 0.01), 3.81729480e-3, 9));
}

TEST(LubkinTest, MasterCurveMatchesPrintedValues) {
  const double reduced[] = {0.25, 0.5, 1.0, 2.0, 4.0};
  const double printed[] = {0.22402568, 0.40220997, 0.65271792, 0.89174643, 0.99169372};
  const LubkinContact contact = twisted_rubber();
  const double natural = saturated_torque(contact) / torsional_stiffness(contact);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(rounds_to(torque(contact, reduced[i] * natural) / saturated_torque(contact),
                          printed[i], 8));
  }
}

TEST(LubkinTest, LossPerCycleMatchesPrintedValuesAndTheLoop) {
  const LubkinContact contact = twisted_rubber();
  EXPECT_TRUE(rounds_to(torsional_loss_per_cycle(contact, 0.02), 4.87825740e-5, 9));
  EXPECT_TRUE(rounds_to(torsional_loss_per_cycle(contact, 0.1), 2.89708735e-3, 9));
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact other = twisted_rubber(shape);
    const double amplitude = 0.08;
    const double work = integrate_tanh_sinh(
        [&](double phi, double, double) { return torque(other, phi); }, 0.0, amplitude);
    // T(phi) of the flat punch has a kink in its slope inside the interval, which costs the
    // quadrature digits.
    EXPECT_NEAR(torsional_loss_per_cycle(other, amplitude),
                8.0 * work - 4.0 * amplitude * torque(other, amplitude),
                1e-6 * amplitude * torque(other, amplitude));
  }
}

TEST(LubkinTest, SlipTwistIsTheAbelIntegralOfThePressure) {
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    const double a = contact.radius;
    for (const double share : {0.01, 0.3, 0.7, 0.99}) {
      const double x = share * a;
      // r = x cosh(t) removes the root at x: p(r) dt; what is left is the pressure's own root at
      // the rim.
      const double end = std::acosh(1.0 / share);
      const double integral = integrate_tanh_sinh(
          [&](double t, double, double) { return contact_pressure(contact, x * std::cosh(t)); },
          0.0, end);
      const double expected = contact.friction / (2.0 * contact.shear_modulus) * integral;
      // 1 / sqrt(a - r) of the flat punch is formed here from a rounded r: half the digits.
      EXPECT_NEAR(slip_twist(contact, x) / expected, 1.0, 1e-7) << share;
      const double h = 1e-5 * x * (1.0 - share);
      const double slope = (slip_twist(contact, x - h) - slip_twist(contact, x + h)) / (2.0 * h);
      EXPECT_NEAR(slip_twist_slope(contact, x) / slope, 1.0, 1e-8) << share;
    }
    EXPECT_NEAR(stick_radius(contact, slip_twist(contact, 0.3 * a)) / a, 0.3, 1e-13);
  }
}

TEST(LubkinTest, SmallSlipFollowsDeresiewicz) {
  // G a^2 phi / (mu F) = (1 - s)(3 - s) / 8, s = sqrt(1 - 1.5 T / (mu F a)) for slip in a thin
  // ring: its first neglected term is of the square of T / T_sat.
  const LubkinContact contact = twisted_rubber();
  const double scale = contact.friction * contact.normal_force;
  for (const double twist : {1e-5, 1e-4, 1e-3}) {
    const double s = std::sqrt(1.0 - 1.5 * torque(contact, twist) / (scale * contact.radius));
    const double theory = (1.0 - s) * (3.0 - s) / 8.0 * scale /
                          (contact.shear_modulus * contact.radius * contact.radius);
    const double share = torque(contact, twist) / saturated_torque(contact);
    EXPECT_NEAR(theory / twist, 1.0, 0.15 * share * share + 1e-9) << twist;
  }
}

TEST(LubkinTest, HugeAndTinyTwistsReachTheLimits) {
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    for (const double twist : {50.0, 1e6}) {
      EXPECT_NEAR(torque(contact, twist) / saturated_torque(contact), 1.0, 1e-12) << twist;
      EXPECT_TRUE(std::isfinite(twist_displacement(contact, twist, 1.5 * contact.radius)));
    }
    // A slipping ring of the width w takes of the order of w^2 of the stiffness, w ~ twist for
    // Hertz and ~ twist^(2/3) for Winkler; the uniform pressure slips most, w ~ twist^2 with a
    // weight of w^(1/2).
    EXPECT_NEAR(torque(contact, 1e-9) / (1e-9 * torsional_stiffness(contact)), 1.0, 1e-5);
    EXPECT_EQ(torque(contact, 0.0), 0.0);
    EXPECT_EQ(torque(contact, -0.02), -torque(contact, 0.02));
  }
}

/// Independent torsional springs 8 G x^2 dx with friction H(x) on [-a, a]: the half-space's
/// torsion, step by step.
struct SpringFoundation {
  LubkinContact contact;
  Quadrature rule;
  std::vector<double> limits;
  std::vector<double> stretches;

  explicit SpringFoundation(const LubkinContact& of, std::size_t count)
      : contact(of), rule(gauss_legendre(count, 0.0, of.radius)), stretches(count, 0.0) {
    for (const double x : rule.nodes) {
      limits.push_back(slip_twist(contact, x));
    }
  }
  double turn_by(double change) {
    double sum = 0.0;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      stretches[i] = std::clamp(stretches[i] + change, -limits[i], limits[i]);
      const double x = rule.nodes[i];
      sum += 16.0 * contact.shear_modulus * rule.weights[i] * x * x * stretches[i];
    }
    return sum;
  }
};

TEST(LubkinTest, HistoryOfManyTurnsEqualsSpringsWithFriction) {
  const LubkinContact contact = twisted_rubber();
  const auto loading = [&](double twist) {
    return torque(contact, twist);
  };
  SpringFoundation springs(contact, 2000);
  MasingHistory history;
  double before = 0.0;
  // Nested loops, one closed exactly, one passed, a swing through zero beyond the first, then the
  // mirror image's side.
  for (const double twist : {0.03, 0.05, 0.01, 0.03, 0.02, 0.03, -0.02, -0.06, 0.0, -0.01, 0.02,
                             -0.1, 0.1, 0.09, 0.12, -0.12, -0.2}) {
    const double expected = springs.turn_by(twist - before);
    before = twist;
    // The rule's kink at each stick radius costs 1/count^2 of the saturated torque.
    EXPECT_NEAR(move_to(history, loading, twist), expected, 1e-6 * saturated_torque(contact))
        << twist;
  }
  EXPECT_TRUE(history.turning_points.empty());
}

TEST(LubkinTest, TurnGivesTheSameAsTheHistory) {
  const LubkinContact contact = twisted_rubber();
  const auto loading = [&](double twist) {
    return torque(contact, twist);
  };
  MasingHistory history;
  move_to(history, loading, 0.08);
  for (const double twist : {0.05, 0.0, -0.05, -0.08}) {
    EXPECT_NEAR(move_to(history, loading, twist), torque_after_turn(contact, 0.08, twist), 1e-15);
  }
  EXPECT_NEAR(torque_after_turn(contact, 0.08, -0.08), -torque(contact, 0.08), 1e-15);
}

}  // namespace
}  // namespace torsion::engine::reference
