// The exact curves behind the window's plots, against the references that they are of.

#include "app/view/exact_curves.hpp"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"

namespace torsion::engine {
namespace {

/// A contact of a sphere that is turned as `turns` says, at a force that may change.
History turned(const std::vector<double>& turns, const std::vector<double>& forces = {},
               double sideways = 0.0) {
  History history;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    LiveRow row;
    row.trace.time = 1.0 + History::kPeriod * static_cast<double>(i);
    row.trace.load.normal_sum = forces.empty() ? 2.0 : forces[i];
    row.trace.load.friction.force.x = sideways;
    row.turn = turns[i];
    row.radius = 0.1;  // whatever the model says
    row.contact = 1;
    history.add(row);
  }
  return history;
}

constexpr double kForce = 2.0;  // N, of turned()
constexpr ExactContact kGel{0.02, 26.7e3, 6.7e3, 0.6};
const reference::LubkinContact kLubkin{reference::PressureShape::kHertz, kForce, kGel.friction,
                                       exact_radius(kGel, kForce), kGel.shear_modulus};

TEST(ExactCurveTest, TheRadiusIsTheSpheresAtItsForce) {
  for (const double radius : {1e-5, 0.004, 0.015}) {
    const double force =
        reference::sneddon_sphere_at_radius(kGel.sphere_radius, kGel.modulus, radius).force;
    EXPECT_NEAR(exact_radius(kGel, force), radius, 1e-9 * radius + 1e-15);
  }
}

TEST(ExactCurveTest, IsLubkinsOnTheWayOutAndMasingsBack) {
  std::vector<double> turns = {0.0, 0.0};
  for (int i = 1; i <= 100; ++i) {
    turns.push_back(0.05 * i);
  }
  for (int i = 1; i <= 200; ++i) {
    turns.push_back(5.0 - 0.05 * i);
  }
  const Curve curve = exact_over_turn(turned(turns), 0, kGel);
  ASSERT_GT(curve.x.size(), 290U);
  // Lines between rows are off most near their middles, and the curve is read from 257 rows at
  // turns of 3 (k / 256)^2 in units of mu F / (G a^2). Masing's way back doubles one error and adds
  // another.
  const double unit =
      kLubkin.friction * kForce / (kLubkin.shear_modulus * kLubkin.radius * kLubkin.radius);
  double chord = 0.0;
  for (int k = 0; k < 256; ++k) {
    const double low = unit * 3.0 * k * k / 65536.0;
    const double high = unit * 3.0 * (k + 1) * (k + 1) / 65536.0;
    const double line = 0.5 * (reference::torque(kLubkin, low) + reference::torque(kLubkin, high));
    chord = std::max(chord, reference::torque(kLubkin, 0.5 * (low + high)) - line);
  }
  const double beyond =
      reference::saturated_torque(kLubkin) - reference::torque(kLubkin, unit * 3.0);
  const double tolerance = 3.0 * (1.1 * chord + beyond);
  EXPECT_LT(tolerance, 1e-3 * reference::saturated_torque(kLubkin));
  bool back = false;
  for (std::size_t i = 1; i < curve.x.size(); ++i) {
    back = back || curve.x[i] < curve.x[i - 1];
    const double turn = curve.x[i] * std::numbers::pi / 180.0;
    const double exact =
        back ? reference::torque_after_turn(kLubkin, 5.0, turn) : reference::torque(kLubkin, turn);
    EXPECT_NEAR(curve.y[i], -exact, tolerance) << turn << (back ? " back" : " out");
  }
}

TEST(ExactCurveTest, EndsWhereItsAssumptionsDo) {
  const std::vector<double> turns = {0.0, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  EXPECT_EQ(exact_over_turn(turned(turns), 0, kGel).x.size(), 5U);
  // The force changes.
  EXPECT_EQ(exact_over_turn(turned(turns, {1.0, 2.0, 2.0, 2.0, 2.0, 1.0, 1.0}), 0, kGel).x.size(),
            3U);
  // While it is pressed, but not turned, it may change.
  EXPECT_EQ(exact_over_turn(turned({0.0, 0.0, 0.0, 0.2}, {0.5, 1.0, 2.0, 2.0}), 0, kGel).x.size(),
            1U);
  // It slides, too: 0.07 N of 1.2 N.
  EXPECT_TRUE(exact_over_turn(turned(turns, {}, 0.07), 0, kGel).x.empty());
  // The beginning is not known any more; another generation; no contact.
  EXPECT_TRUE(exact_over_turn(turned({0.3, 0.4}), 0, kGel).x.empty());
  EXPECT_TRUE(exact_over_turn(turned(turns), 1, kGel).x.empty());
  EXPECT_TRUE(exact_over_turn(turned(turns, std::vector(7, 0.0)), 0, kGel).x.empty());
  EXPECT_TRUE(exact_over_turn({}, 0, kGel).x.empty());
}

TEST(ExactCurveTest, TheLimitGoesFromSpinToSlide) {
  const Curve limit = exact_limit(kForce, kGel);
  EXPECT_NEAR(limit.x.front(), 0.0, 1e-12);
  EXPECT_NEAR(limit.y.front(), reference::saturated_torque(kLubkin), 1e-12);
  EXPECT_NEAR(limit.x.back(), 1.2, 1e-9);
  EXPECT_NEAR(limit.y.back(), 0.0, 1e-9);
}

}  // namespace
}  // namespace torsion::engine
