#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/materials.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/exact/reissner_sagoci.hpp"
#include "tests/reference/printed_number.hpp"
#include "tests/reference/twisted_rubber.hpp"

namespace torsion::engine::reference {
namespace {

using std::numbers::pi;

TEST(TwistFieldTest, MatchesPrintedValues) {
  const LubkinContact contact = twisted_rubber();
  const double radii[] = {0.3, 0.6, 0.8, 1.0, 1.1, 1.5, 2.0, 3.0};
  const double printed[] = {1.0, 1.0, 0.804579, 0.374067, 0.247259, 0.083637, 0.033354, 0.009540};
  for (int i = 0; i < 8; ++i) {
    const double r = radii[i] * contact.radius;
    EXPECT_NEAR(twist_displacement(contact, 0.05, r) / (0.05 * r), printed[i], 0.51e-6) << radii[i];
  }
}

TEST(TwistFieldTest, IsARigidTurnWhereItSticksForEveryPressure) {
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    for (const double twist : {0.01, 0.05, 0.2}) {
      const double c = stick_radius(contact, twist);
      for (const double share : {0.1, 0.5, 0.999}) {
        const double r = share * c;
        EXPECT_NEAR(twist_displacement(contact, twist, r) / (twist * r), 1.0, 1e-11);
      }
    }
  }
}

TEST(TwistFieldTest, LagsBehindTheToolWhereItSlips) {
  // Friction does positive work only if the body's surface has turned less than the tool over every
  // slipping ring.
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    const double c = stick_radius(contact, 0.06);
    double before = 1.0;
    for (int i = 1; i <= 20; ++i) {
      const double r = c + (contact.radius - c) * i / 20.0;
      const double ratio = twist_displacement(contact, 0.06, r) / (0.06 * r);
      if (c < contact.radius) {
        EXPECT_LT(ratio, before) << i;
      }
      before = ratio;
    }
  }
}

TEST(TwistFieldTest, TractionOfTheDiscsObeysFrictionWhereItSlips) {
  // The discs were weighted so that their tractions add up to mu p outside the stick radius: their
  // sum is formed here anew, over s from r to the rim, without the shortcut of twist_traction().
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    const double a = contact.radius;
    for (const double share : {0.2, 0.6, 0.95}) {
      const double r = share * a;
      const double rim = slip_twist(contact, a) / std::sqrt((a - r) * (a + r));
      const double discs = integrate_tanh_sinh(
          [&](double s, double from, double) {
            return slip_twist_slope(contact, std::min(s, a * (1.0 - 1e-15))) /
                   std::sqrt(from * (s + r));
          },
          r, a);
      const double traction = 4.0 * contact.shear_modulus * r / pi * (rim + discs);
      // The uniform pressure's weight is infinite at the rim, where s is rounded: half the digits.
      EXPECT_NEAR(traction / (contact.friction * contact_pressure(contact, r)), 1.0, 1e-7) << share;
    }
  }
}

TEST(TwistFieldTest, TractionCarriesTheTorqueAndStaysUnderFriction) {
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    const double a = contact.radius;
    for (const double twist : {0.02, 0.08}) {
      const double c = stick_radius(contact, twist);
      const auto ring = [&](double r, double, double) {
        return 2.0 * pi * r * r * twist_traction(contact, twist, r);
      };
      const double sum =
          integrate_tanh_sinh(ring, 0.0, c) + (c < a ? integrate_tanh_sinh(ring, c, a) : 0.0);
      // 1 / sqrt(a - r) of the flat punch from a rounded r: half the digits.
      EXPECT_NEAR(sum / torque(contact, twist), 1.0, 3e-8);
      for (const double share : {0.1, 0.5, 0.9, 0.999}) {
        const double r = share * c;
        if (c < a) {
          EXPECT_LT(twist_traction(contact, twist, r),
                    contact.friction * contact_pressure(contact, r));
        }
      }
    }
  }
}

TEST(TwistFieldTest, SlopeAtTheSurfaceIsTheTractionAndThereIsNoneOutside) {
  const LubkinContact contact = twisted_rubber();
  const double a = contact.radius;
  const double twist = 0.05;
  for (const double share : {0.3, 0.5, 0.85, 1.3, 2.0}) {
    const double r = share * a;
    const double h = 1e-3 * a;
    const auto u = [&](int i) {
      return twist_displacement(contact, twist, r, i * h);
    };
    // Third-order one-sided difference: error h^3 u'''' / 4 ~ 1e-9 u / (0.15^4 a) beside the stick
    // radius.
    const double slope = (-11.0 * u(0) + 18.0 * u(1) - 9.0 * u(2) + 2.0 * u(3)) / (6.0 * h);
    const double limit = contact.friction * contact_pressure(contact, 0.0);
    EXPECT_NEAR(-contact.shear_modulus * slope, twist_traction(contact, twist, r), 1e-5 * limit)
        << share;
  }
}

TEST(TwistFieldTest, FarFieldIsThatOfTheTorque) {
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    const double distance = 300.0 * contact.radius;
    const double far =
        torque(contact, 0.07) * 0.6 / (4.0 * pi * contact.shear_modulus * distance * distance);
    // The next term is smaller by (a / distance)^2 = 1.1e-5.
    EXPECT_NEAR(twist_displacement(contact, 0.07, 0.6 * distance, 0.8 * distance) / far, 1.0, 2e-5);
  }
}

TEST(TwistFieldTest, IsContinuousAcrossStickRadiusAndRim) {
  for (const PressureShape shape : kPressureShapes) {
    const LubkinContact contact = twisted_rubber(shape);
    const double twist = 0.05;
    for (const double r : {stick_radius(contact, twist), contact.radius}) {
      // The field of a disc has a vertical slope of sqrt at its rim at most: 1e-9 aside it changes
      // by sqrt(1e-9).
      EXPECT_NEAR(twist_displacement(contact, twist, r * (1.0 - 1e-9)),
                  twist_displacement(contact, twist, r * (1.0 + 1e-9)), 1e-4 * twist * r);
    }
  }
}

TEST(TwistFieldTest, ReversesToItsMirrorImage) {
  const LubkinContact contact = twisted_rubber();
  for (const double share : {0.5, 0.9, 1.4}) {
    const double r = share * contact.radius;
    EXPECT_NEAR(twist_displacement_after_turn(contact, 0.06, -0.06, r),
                -twist_displacement(contact, 0.06, r), 1e-15);
  }
  // Part of the twist remains after a turn back to zero torque: less than the slip, more than
  // nothing.
  EXPECT_GT(twist_displacement_after_turn(contact, 0.06, 0.0, contact.radius),
            -0.06 * contact.radius);
  EXPECT_NE(twist_displacement_after_turn(contact, 0.06, 0.0, contact.radius), 0.0);
}

}  // namespace
}  // namespace torsion::engine::reference
