#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/reference/exact/flat_punch.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/hertz_ellipse.hpp"
#include "tests/reference/exact/materials.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/printed_number.hpp"

namespace torsion::engine::reference {
namespace {

using std::numbers::pi;

/// Boussinesq: u = 1 / (pi E*) times the integral of the pressure over the distance, in polar
/// coordinates around the place (x, y) inside the contact, where the distance cancels.
/// @param to_rim(direction) distance from the place to the rim
template <class Pressure, class ToRim>
double superposed_displacement(double modulus, double x, double y, const Pressure& pressure,
                               const ToRim& to_rim) {
  // The trapezium rule over the full circle converges geometrically for smooth periodic integrands.
  constexpr int kDirections = 128;
  double sum = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const double direction = 2.0 * pi * i / kDirections;
    sum += integrate_tanh_sinh(
        [&](double s, double, double) {
          return pressure(x + s * std::cos(direction), y + s * std::sin(direction));
        },
        0.0, to_rim(direction));
  }
  return sum * 2.0 * pi / kDirections / (pi * modulus);
}

TEST(HertzTest, MatchesPrintedContacts) {
  struct Row {
    double sphere, force, young, poisson, radius, depth, peak, stiffness;
  };
  const Row rows[] = {
      {0.05, 10.0, 3e6, 0.5, 4.54280148e-3, 4.12740906e-4, 2.31362980e5, 3.634241e4},
      {0.05, 1.0, 3e6, 0.5, 2.10858166e-3, 8.89223326e-5, 1.07389182e5, 1.686865e4},
      {0.05, 100.0, 3e6, 0.5, 9.78716910e-3, 1.91577358e-3, 4.98456429e5, 7.829735e4},
      {0.01, 0.1, 1e5, 0.3, 1.89685537e-3, 3.59806030e-4, 1.32700619e4, 4.168913e2},
      {0.02, 0.2, 5e4, 0.45, 3.63045157e-3, 6.59008929e-4, 7.24519514e3, 4.552290e2},
  };
  for (const Row& row : rows) {
    const HertzSphere contact =
        hertz_sphere_at_force(row.sphere, contact_modulus(row.young, row.poisson), row.force);
    EXPECT_TRUE(rounds_to(contact.radius, row.radius, 9));
    EXPECT_TRUE(rounds_to(contact.depth, row.depth, 9));
    EXPECT_TRUE(rounds_to(contact.peak_pressure, row.peak, 9));
    EXPECT_TRUE(rounds_to(contact.stiffness, row.stiffness, 7));
    const HertzSphere again = hertz_sphere_at_depth(row.sphere, contact.modulus, contact.depth);
    EXPECT_NEAR(again.force / row.force, 1.0, 1e-14);
  }
}

TEST(HertzTest, PressureCarriesTheForceAndStiffnessIsItsSlope) {
  const HertzSphere contact = hertz_sphere_at_depth(0.05, 4e6, 4e-4);
  const double force = integrate_tanh_sinh(
      [&](double r, double, double) { return 2.0 * pi * r * hertz_pressure(contact, r); }, 0.0,
      contact.radius);
  EXPECT_NEAR(force / contact.force, 1.0, 1e-12);
  const double h = 1e-8;
  const double slope = (hertz_sphere_at_depth(0.05, 4e6, 4e-4 + h).force -
                        hertz_sphere_at_depth(0.05, 4e6, 4e-4 - h).force) /
                       (2.0 * h);
  // h^2 F''' / 6 is 1e-10 of it, cancellation 1e-16 F / (h k) as much.
  EXPECT_NEAR(slope / contact.stiffness, 1.0, 1e-8);
}

TEST(HertzTest, DisplacementIsThatOfItsPressure) {
  const HertzSphere contact = hertz_sphere_at_depth(0.05, 4e6, 4e-4);
  const double a = contact.radius;
  const auto pressure = [&](double x, double y) {
    return hertz_pressure(contact, std::hypot(x, y));
  };
  for (const double share : {0.0, 0.4, 0.8}) {
    const double r = share * a;
    const double sum =
        superposed_displacement(contact.modulus, r, 0.0, pressure, [&](double direction) {
          const double along = r * std::cos(direction);
          return -along + std::sqrt(along * along + a * a - r * r);
        });
    EXPECT_NEAR(hertz_surface_displacement(contact, r) / sum, 1.0, 1e-6) << share;
    EXPECT_NEAR(hertz_surface_displacement(contact, r), contact.depth - r * r / 0.1, 1e-17)
        << share;
  }
  // Outside, by the rings of pressure: the mean of 1 / distance over a ring of radius s is (2 / (pi
  // r)) K(s^2 / r^2).
  for (const double share : {1.01, 1.5, 4.0, 29.0, 31.0, 200.0}) {
    const double r = share * a;
    const double sum = integrate_tanh_sinh(
        [&](double s, double, double to_rim) {
          const double p = contact.peak_pressure * std::sqrt(to_rim * (a + s)) / a;
          return p * 2.0 * pi * s * 2.0 / (pi * r) * std::comp_ellint_1(s / r);
        },
        0.0, a);
    EXPECT_NEAR(hertz_surface_displacement(contact, r) / (sum / (pi * contact.modulus)), 1.0, 1e-11)
        << share;
  }
}

TEST(SneddonTest, ExcessOverHertzMatchesPrintedValues) {
  const double shares[] = {0.05, 0.0909, 0.2, 0.3, 0.5, 0.7};
  const double percent[] = {0.025, 0.083, 0.41, 0.94, 2.8, 6.5};
  const int digits[] = {2, 2, 2, 2, 2, 2};
  for (int i = 0; i < 6; ++i) {
    const SneddonSphere exact = sneddon_sphere_at_radius(0.05, 4e6, shares[i] * 0.05);
    const double hertz = hertz_sphere_at_depth(0.05, 4e6, exact.depth).force;
    EXPECT_TRUE(rounds_to(100.0 * (hertz / exact.force - 1.0), percent[i], digits[i])) << shares[i];
  }
}

TEST(SneddonTest, IsTheSphereOfDimensionalityReduction) {
  // g(x) = x int_0^x f'(r) / sqrt(x^2 - r^2) dr with f' = r / sqrt(R^2 - r^2); with r = x sin t the
  // root is gone.
  const double sphere = 0.05;
  const double a = 0.03;
  const auto g = [&](double x) {
    return integrate_tanh_sinh(
        [&](double t, double, double) {
          const double r = x * std::sin(t);
          return x * r / std::sqrt((sphere - r) * (sphere + r));
        },
        0.0, pi / 2.0);
  };
  const double depth = g(a);
  const double force =
      2.0 * 4e6 *
      integrate_tanh_sinh([&](double x, double, double) { return depth - g(x); }, 0.0, a);
  const SneddonSphere exact = sneddon_sphere_at_radius(sphere, 4e6, a);
  EXPECT_NEAR(exact.depth / depth, 1.0, 1e-12);
  EXPECT_NEAR(exact.force / force, 1.0, 1e-12);
}

TEST(SneddonTest, DepthAndRadiusAreInverse) {
  for (const double share : {1e-4, 0.2, 0.3, 0.9}) {
    const SneddonSphere exact = sneddon_sphere_at_radius(0.05, 4e6, share * 0.05);
    const SneddonSphere again = sneddon_sphere_at_depth(0.05, 4e6, exact.depth);
    EXPECT_NEAR(again.radius / exact.radius, 1.0, 1e-13) << share;
    EXPECT_NEAR(again.force / exact.force, 1.0, 1e-12) << share;
  }
}

TEST(HertzEllipseTest, MatchesPrintedContacts) {
  struct Row {
    double ax, ay, az, force, young, poisson, a, b, peak, depth;
  };
  const Row rows[] = {
      {0.06, 0.04, 0.03, 10.0, 3e6, 0.5, 6.89467177e-3, 4.02180594e-3, 1.721895e5, 3.49708648e-4},
      {0.08, 0.03, 0.03, 5.0, 3e6, 0.5, 7.64723915e-3, 2.11011380e-3, 1.479452e5, 2.11272796e-4},
      {0.10, 0.02, 0.02, 2.0, 1e5, 0.3, 2.78446168e-2, 3.50513466e-3, 9.784202e3, 1.08247191e-3},
  };
  for (const Row& row : rows) {
    const double larger = row.ax * row.ax / row.az;
    const double smaller = row.ay * row.ay / row.az;
    const HertzEllipse contact =
        hertz_ellipse_at_force(larger, smaller, contact_modulus(row.young, row.poisson), row.force);
    EXPECT_TRUE(rounds_to(contact.major, row.a, 9));
    EXPECT_TRUE(rounds_to(contact.minor, row.b, 9));
    EXPECT_TRUE(rounds_to(contact.peak_pressure, row.peak, 7));
    EXPECT_TRUE(rounds_to(contact.depth, row.depth, 9));
    EXPECT_NEAR(contact.force / row.force, 1.0, 1e-13);
    const HertzEllipse again =
        hertz_ellipse_at_depth(larger, smaller, contact.modulus, contact.depth);
    EXPECT_NEAR(again.force / row.force, 1.0, 1e-12);
  }
}

TEST(HertzEllipseTest, EqualRadiiGiveTheCircle) {
  const HertzSphere circle = hertz_sphere_at_force(0.05, 4e6, 10.0);
  for (const double larger : {0.05, 0.05 * (1.0 + 1e-12), 0.05 * (1.0 + 1e-7)}) {
    const HertzEllipse ellipse = hertz_ellipse_at_force(larger, 0.05, 4e6, 10.0);
    EXPECT_NEAR(ellipse.major / circle.radius, 1.0, 1e-6);
    EXPECT_NEAR(ellipse.depth / circle.depth, 1.0, 1e-6);
  }
}

TEST(HertzEllipseTest, DisplacementIsThatOfItsPressureAndTheBodysShape) {
  const double larger = 0.12;
  const double smaller = 0.03;
  const HertzEllipse contact = hertz_ellipse_at_force(larger, smaller, 4e6, 5.0);
  const double a = contact.major;
  const double b = contact.minor;
  for (const auto& [sx, sy] : {std::pair{0.0, 0.0}, {0.5, 0.3}, {0.1, 0.9}, {0.7, 0.0}}) {
    const double x = sx * a;
    const double y = sy * b;
    const double shape = contact.depth - 0.5 * x * x / larger - 0.5 * y * y / smaller;
    EXPECT_NEAR(hertz_ellipse_displacement(contact, x, y) / shape, 1.0, 1e-11);
  }
  const auto pressure = [&](double x, double y) {
    return hertz_ellipse_pressure(contact, x, y);
  };
  const double middle =
      superposed_displacement(contact.modulus, 0.0, 0.0, pressure, [&](double direction) {
        return 1.0 / std::hypot(std::cos(direction) / a, std::sin(direction) / b);
      });
  EXPECT_NEAR(contact.depth / middle, 1.0, 1e-7);
}

TEST(HertzEllipseTest, DisplacementOutsideIsThatOfItsPressure) {
  const HertzEllipse contact = hertz_ellipse_at_force(0.12, 0.03, 4e6, 5.0);
  const double a = contact.major;
  const double b = contact.minor;
  // The contact as a stretched disc, t = sin(angle) taking the root of the pressure away.
  const Quadrature radial = gauss_legendre(60, 0.0, pi / 2.0);
  constexpr int kDirections = 400;
  for (const auto& [x, y] :
       {std::pair{1.3 * a, 0.0}, {0.0, 2.0 * b}, {a, b}, {20.0 * a, 9.0 * a}}) {
    double sum = 0.0;
    for (int i = 0; i < kDirections; ++i) {
      const double direction = 2.0 * pi * i / kDirections;
      sum += integrate(radial, [&, x = x, y = y](double angle) {
        const double t = std::sin(angle);
        const double distance =
            std::hypot(x - a * t * std::cos(direction), y - b * t * std::sin(direction));
        return contact.peak_pressure * std::pow(std::cos(angle), 2) * t * a * b / distance;
      });
    }
    const double expected = sum * 2.0 * pi / kDirections / (pi * contact.modulus);
    EXPECT_NEAR(hertz_ellipse_displacement(contact, x, y) / expected, 1.0, 1e-10) << x << " " << y;
  }
  // Continuous through the rim, where the slope is finite.
  EXPECT_NEAR(hertz_ellipse_displacement(contact, a * (1.0 + 1e-9), 0.0),
              hertz_ellipse_displacement(contact, a * (1.0 - 1e-9), 0.0), 1e-8 * contact.depth);
}

TEST(FlatPunchTest, MatchesPrintedValues) {
  const FlatPunch small{0.005, 4e6, 1e-4};
  EXPECT_TRUE(rounds_to(flat_punch_force(small), 4.0, 12));
  EXPECT_TRUE(rounds_to(flat_punch_pressure(small, 0.0), 2.546479e4, 7));
  EXPECT_TRUE(rounds_to(flat_punch_displacement(small, 0.01), 3.333333e-5, 7));
  const FlatPunch large{0.01, 4e6, 5e-4};
  EXPECT_TRUE(rounds_to(flat_punch_force(large), 40.0, 12));
  EXPECT_TRUE(rounds_to(flat_punch_displacement(large, 0.1), 3.188428e-5, 7));
  EXPECT_TRUE(
      rounds_to(flat_punch_force({0.002, contact_modulus(1e5, 0.3), 1e-4}), 4.39560440e-2, 9));
}

TEST(FlatPunchTest, BondedRatioMatchesPrintedValuesAndItsLimit) {
  EXPECT_TRUE(rounds_to(bonded_punch_ratio(0.0), 1.09861, 6));
  EXPECT_TRUE(rounds_to(bonded_punch_ratio(0.3), 1.02863, 6));
  EXPECT_TRUE(rounds_to(bonded_punch_ratio(0.45), 1.00277, 6));
  EXPECT_EQ(bonded_punch_ratio(0.5), 1.0);
  // With gap = 1 - 2 nu it is (1 + gap) ln(1 + 2 gap) / (2 gap) = 1 + gap^2 / 3 + ...
  EXPECT_NEAR(bonded_punch_ratio(0.5 - 1e-9), 1.0, 1e-15);
}

TEST(FlatPunchTest, PressureCarriesTheForceAndFarFieldIsThatOfAPoint) {
  const FlatPunch punch{0.005, 4e6, 1e-4};
  const double force = integrate_tanh_sinh(
      [&](double r, double, double to_rim) {
        return 2.0 * pi * r * punch.modulus * punch.depth / (pi * std::sqrt(to_rim * (0.005 + r)));
      },
      0.0, punch.radius);
  EXPECT_NEAR(force / flat_punch_force(punch), 1.0, 1e-12);
  const double far = flat_punch_force(punch) / (pi * punch.modulus * 5.0);
  // asin(t) = t (1 + t^2 / 6), t = 1e-3.
  EXPECT_NEAR(flat_punch_displacement(punch, 5.0) / far, 1.0, 2e-7);
}

}  // namespace
}  // namespace torsion::engine::reference
