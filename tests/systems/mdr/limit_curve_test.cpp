#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/mdr/places.hpp"
#include "tests/reference/exact/limit_surface.hpp"

namespace torsion::engine {
namespace {

/// A load in the reference's units: force over mu F, couple over mu F a.
reference::SlidingSpinning in_units(const glm::dvec2& load) {
  return {load.x, load.y * reference::pure_spin_moment()};
}

TEST(LimitCurveTest, LiesOnTheExactCurveAndSagsLittleInside) {
  const LimitCurve curve = make_limit_curve();
  double deepest = 1.0;
  for (int k = 0; k < kLimitCurveSegments; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const glm::dvec2& from = curve.points[index];
    const glm::dvec2& to = curve.points[index + 1];
    EXPECT_NEAR(reference::hertz_limit_load(in_units(from)), 1.0, 1e-9) << k;
    for (int part = 1; part < 16; ++part) {
      const double size = reference::hertz_limit_load(in_units(from + (part / 16.0) * (to - from)));
      EXPECT_LE(size, 1.0 + 1e-12) << k;
      deepest = std::min(deepest, size);
    }
  }
  EXPECT_GE(deepest, 1.0 - 5e-5);  // what places.hpp states
}

TEST(LimitCurveTest, KeepsLoadsInsideAndBringsOthersToTheNearestPoint) {
  const LimitCurve curve = make_limit_curve();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 2.0);
  std::uniform_real_distribution<double> exponent(-3.0, 3.0);
  std::size_t segment = 0;  // of the trial before: begins anywhere
  for (int trial = 0; trial < 2000; ++trial) {
    const glm::dvec2 load(part(random), part(random));
    const glm::dvec2 weights(1.0, std::pow(10.0, exponent(random)));
    const glm::dvec2 kept = nearest_inside(curve, load, weights, segment);
    // Nearest of all corners and of 20 points on each side.
    double nearest = 1e300;
    for (std::size_t k = 0; k < kLimitCurveSegments; ++k) {
      for (int step = 0; step <= 20; ++step) {
        const glm::dvec2 place =
            curve.points[k] + (step / 20.0) * (curve.points[k + 1] - curve.points[k]);
        const glm::dvec2 way = load - place;
        nearest = std::min(nearest, glm::dot(weights * way, way));
      }
    }
    const glm::dvec2 way = load - kept;
    const double distance = glm::dot(weights * way, way);
    if (kept == load) {
      EXPECT_LE(reference::hertz_limit_load(in_units(load)), 1.0 + 1e-12);
    } else {
      EXPECT_GE(reference::hertz_limit_load(in_units(load)), 1.0 - 5e-5);
      EXPECT_LE(distance, nearest * (1.0 + 1e-9));
    }
  }
}

TEST(LimitCurveTest, PureLoadsAreKeptPure) {
  const LimitCurve curve = make_limit_curve();
  for (const double weight : {1e-3, 1.0, 1e3}) {
    for (std::size_t segment : {std::size_t{0}, std::size_t{kLimitCurveSegments}}) {
      EXPECT_EQ(nearest_inside(curve, {5.0, 0.0}, {1.0, weight}, segment), glm::dvec2(1.0, 0.0));
      EXPECT_EQ(nearest_inside(curve, {0.0, 5.0}, {1.0, weight}, segment), glm::dvec2(0.0, 1.0));
    }
  }
}

}  // namespace
}  // namespace torsion::engine
