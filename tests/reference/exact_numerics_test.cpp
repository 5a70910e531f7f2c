#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/reference/exact/elliptic_integrals.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/exact/stable_differences.hpp"

namespace torsion::engine::reference {
namespace {

using std::numbers::pi;

TEST(EllipticIntegralsTest, AgreeWithTheStandardLibrary) {
  for (const double m : {0.0, 1e-3, 0.1, 0.5, 0.9, 0.999}) {
    EXPECT_NEAR(elliptic_k(m), std::comp_ellint_1(std::sqrt(m)), 1e-13 * elliptic_k(m)) << m;
    EXPECT_NEAR(elliptic_e(m), std::comp_ellint_2(std::sqrt(m)), 1e-13) << m;
  }
}

TEST(EllipticIntegralsTest, FulfilLegendresRelation) {
  // E K' + E' K - K K' = pi/2 ties the two ends of the parameter's range together.
  for (const double m : {1e-12, 1e-6, 0.01, 0.3, 0.5}) {
    const CompleteElliptic here = complete_elliptic(m, 1.0 - m);
    const CompleteElliptic there = complete_elliptic(1.0 - m, m);
    EXPECT_NEAR(there.e * here.k - here.k_minus_e * there.k, pi / 2.0, 1e-13) << m;
  }
}

TEST(EllipticIntegralsTest, DifferencesKeepTheirDigitsForSmallParameters) {
  // K - E = (pi/4) m (1 + 3 m / 8 + ...), E - (1 - m) K = (pi/4) m (1 + m / 8 + ...).
  for (const double m : {1e-15, 1e-12, 1e-9}) {
    const CompleteElliptic both = complete_elliptic(m, 1.0 - m);
    EXPECT_NEAR(both.k_minus_e / (pi / 4.0 * m), 1.0 + 0.375 * m, 1e-14) << m;
    EXPECT_NEAR(both.e_minus_complement_k / (pi / 4.0 * m), 1.0 + 0.125 * m, 1e-14) << m;
  }
}

TEST(EllipticIntegralsTest, DifferencesKeepTheirDigitsNearOne) {
  // K = ln(4 / k') + (ln(4 / k') - 1) k'^2 / 4, E = 1 + (ln(4 / k') - 1/2) k'^2 / 2 with k'^2 = 1 -
  // m: the terms left out are of the order of k'^4 ln k'.
  for (const double complement : {1e-6, 1e-10, 1e-100, 1e-290}) {
    const CompleteElliptic both = complete_elliptic(1.0 - complement, complement);
    const double log4 = std::log(4.0) - 0.5 * std::log(complement);
    const double k = log4 + 0.25 * (log4 - 1.0) * complement;
    const double e = 1.0 + 0.5 * (log4 - 0.5) * complement;
    EXPECT_NEAR(both.k_minus_e / (k - e), 1.0, 1e-11) << complement;
    EXPECT_NEAR(both.e_minus_complement_k / (e - complement * k), 1.0, 1e-11) << complement;
  }
}

TEST(QuadratureTest, GaussLegendreIsExactForPolynomialsOfItsDegree) {
  for (const std::size_t count : {1U, 2U, 5U, 20U, 101U}) {
    const Quadrature rule = gauss_legendre(count, 0.0, 2.0);
    const auto degree = 2.0 * static_cast<double>(count) - 1.0;
    const double exact = std::pow(2.0, degree + 1.0) / (degree + 1.0);
    const double found = integrate(rule, [&](double x) { return std::pow(x, degree); });
    // Rounding of x^degree alone is degree times 1e-16.
    EXPECT_NEAR(found / exact, 1.0, 1e-15 * degree + 1e-14) << count;
  }
}

TEST(QuadratureTest, TanhSinhReachesItsErrorAtSingularEnds) {
  const auto root = integrate_tanh_sinh(
      [](double, double from, double) { return 1.0 / std::sqrt(from); }, 1.0, 3.0);
  EXPECT_NEAR(root, 2.0 * std::sqrt(2.0), 1e-13);
  const auto both = integrate_tanh_sinh(
      [](double, double from, double to) { return 1.0 / std::sqrt(from * to); }, -1.0, 1.0);
  EXPECT_NEAR(both, pi, 1e-13);
  const auto logarithm =
      integrate_tanh_sinh([](double, double from, double) { return std::log(from); }, 0.0, 1.0);
  EXPECT_NEAR(logarithm, -1.0, 1e-13);
  const auto smooth =
      integrate_tanh_sinh([](double x, double, double) { return std::exp(x); }, 0.0, 2.0);
  EXPECT_NEAR(smooth, std::expm1(2.0), 1e-13 * smooth);
}

TEST(StableDifferencesTest, SeriesMeetsTheClosedForm) {
  // On both sides of the change-over; there the closed form has lost t^3 / t = 0.1 of its digits at
  // most.
  for (const double t : {0.2999999, 0.3, 0.3000001}) {
    const double closed = (1.0 + t * t) * std::atanh(t) - t;
    EXPECT_NEAR(atanh_difference(t, std::atanh(t)) / closed, 1.0, 3e-14) << t;
  }
}

}  // namespace
}  // namespace torsion::engine::reference
