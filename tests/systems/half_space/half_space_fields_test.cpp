// The closed forms against what defines them: the half-space's equations by differences, the load
// that comes out of a hemisphere around it, and the exact solutions for a disc.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "systems/half_space/fields.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

const Port kLoad{glm::dvec3(0.3, -0.2, 0.1), glm::normalize(glm::dvec3(0.3, 0.8, -0.4))};

/// Row 0 to 5: unit force along, unit torque about each body axis.
Wrench unit_wrench(int row) {
  Wrench wrench;
  (row < 3 ? wrench.force : wrench.torque)[row % 3] = 1.0;
  return wrench;
}

Elasticity with_ratio(double poisson_ratio) {
  return {2.0, poisson_ratio, 1000.0};
}

/// A point at `distance` below the surface of kLoad's half-space, `share` of the way down.
glm::dvec3 point_below(double distance, double share, double angle) {
  const glm::dvec3 first = glm::normalize(glm::cross(kLoad.normal, glm::dvec3(1.0, 0.0, 0.0)));
  const glm::dvec3 second = glm::cross(kLoad.normal, first);
  const double flat = std::sqrt(1.0 - share * share);
  return kLoad.position + distance * (flat * std::cos(angle) * first +
                                      flat * std::sin(angle) * second - share * kLoad.normal);
}

glm::dmat3 gradient_of_displacement(const Elasticity& elasticity, const Wrench& wrench,
                                    const glm::dvec3& point, double step) {
  glm::dmat3 gradient(0.0);
  for (int c = 0; c < 3; ++c) {
    glm::dvec3 shift(0.0);
    shift[c] = step;
    gradient[c] = (half_space_motion(kLoad, elasticity, wrench, point + shift).displacement -
                   half_space_motion(kLoad, elasticity, wrench, point - shift).displacement) /
                  (2.0 * step);
  }
  return gradient;
}

TEST(HalfSpaceFieldsTest, RotationIsHalfTheCurlAndMeanStressFollowsFromTheDivergence) {
  // Central differences with step 1e-4 of the distance are right to 1e-7.
  for (const double poisson_ratio : {0.0, 0.3, 0.49}) {
    const Elasticity elasticity = with_ratio(poisson_ratio);
    const double bulk = elasticity.youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio));
    for (int row = 0; row < 6; ++row) {
      const Wrench wrench = unit_wrench(row);
      for (const double share : {0.05, 0.4, 0.9}) {
        const glm::dvec3 point = point_below(0.7, share, 1.0 + row);
        const glm::dmat3 g = gradient_of_displacement(elasticity, wrench, point, 7e-5);
        const glm::dvec3 curl(g[1][2] - g[2][1], g[2][0] - g[0][2], g[0][1] - g[1][0]);
        const glm::dvec3 rotation = half_space_motion(kLoad, elasticity, wrench, point).rotation;
        EXPECT_NEAR(glm::length(0.5 * curl - rotation), 0.0, 1e-6) << row << ' ' << share;
        const glm::dmat3 stress = half_space_stress(kLoad, elasticity, wrench, point);
        EXPECT_NEAR(bulk * (g[0][0] + g[1][1] + g[2][2]),
                    (stress[0][0] + stress[1][1] + stress[2][2]) / 3.0, 1e-6 * bulk)
            << row << ' ' << share;
      }
    }
  }
}

TEST(HalfSpaceFieldsTest, GradientIsTheDisplacementsDerivative) {
  // Also above the plane, where R + z is bent (share < -0.6): differences as above are right to
  // 1e-6 of the largest there, where s is as small as R / 5.
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    const Elasticity elasticity = with_ratio(poisson_ratio);
    for (int row = 0; row < 6; ++row) {
      for (const double share : {0.9, 0.4, 0.0, -0.5, -0.7, -0.95}) {
        const glm::dvec3 point = point_below(0.7, share, 1.0 + row);
        const glm::dmat3 wanted =
            gradient_of_displacement(elasticity, unit_wrench(row), point, 7e-5);
        const glm::dmat3 found = half_space_gradient(kLoad, elasticity, unit_wrench(row), point);
        double largest = 0.0;
        double error = 0.0;
        for (int c = 0; c < 3; ++c) {
          largest = std::max(largest, glm::length(wanted[c]));
          error = std::max(error, glm::length(found[c] - wanted[c]));
        }
        EXPECT_LT(error, 1e-6 * largest) << row << ' ' << share << ' ' << poisson_ratio;
      }
    }
  }
}

TEST(HalfSpaceFieldsTest, StressIsInEquilibriumAndLeavesTheSurfaceFree) {
  // Differences over 1e-2 of the distance are off by 1e-4.
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    const Elasticity elasticity = with_ratio(poisson_ratio);
    for (int row = 0; row < 6; ++row) {
      const Wrench wrench = unit_wrench(row);
      const glm::dvec3 inside = point_below(1.0, 0.5, 0.4 + row);
      glm::dvec3 divergence(0.0);
      for (int c = 0; c < 3; ++c) {
        glm::dvec3 shift(0.0);
        shift[c] = 0.01;
        divergence += (half_space_stress(kLoad, elasticity, wrench, inside + shift)[c] -
                       half_space_stress(kLoad, elasticity, wrench, inside - shift)[c]) /
                      0.02;
      }
      EXPECT_LT(glm::length(divergence), 2e-3) << row;
      const glm::dvec3 surface = point_below(1.0, 0.0, 0.4 + row);
      const glm::dvec3 traction =
          half_space_stress(kLoad, elasticity, wrench, surface) * kLoad.normal;
      EXPECT_LT(glm::length(traction), 1e-14) << row;
    }
  }
}

TEST(HalfSpaceFieldsTest, HemisphereAroundTheLoadCarriesIt) {
  // The midpoint rule on 60 x 120 patches is right to 1e-3 and better.
  constexpr int kRings = 60;
  constexpr int kSectors = 120;
  for (const double poisson_ratio : {0.0, 0.5}) {
    for (int row = 0; row < 6; ++row) {
      const Wrench wrench = unit_wrench(row);
      Wrench sum = wrench;
      for (int ring = 0; ring < kRings; ++ring) {
        const double share = (ring + 0.5) / kRings;
        for (int sector = 0; sector < kSectors; ++sector) {
          const glm::dvec3 point = point_below(0.5, share, 2.0 * pi * (sector + 0.5) / kSectors);
          const glm::dvec3 arm = point - kLoad.position;
          const double area = 2.0 * pi * 0.25 / (kRings * kSectors);
          const glm::dvec3 force =
              area * (half_space_stress(kLoad, with_ratio(poisson_ratio), wrench, point) *
                      glm::normalize(arm));
          sum.force += force;
          sum.torque += glm::cross(arm, force);
        }
      }
      EXPECT_LT(glm::length(sum.force), 2e-3) << row;
      EXPECT_LT(glm::length(sum.torque), 2e-3) << row;
    }
  }
}

TEST(HalfSpaceFieldsTest, SurfaceResponseIsReciprocal) {
  const Elasticity elasticity = with_ratio(0.3);
  const Port other{point_below(0.8, 0.0, 2.0), kLoad.normal};
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      const MaterialMotion there =
          half_space_motion(kLoad, elasticity, unit_wrench(column), other.position);
      const MaterialMotion here =
          half_space_motion(other, elasticity, unit_wrench(row), kLoad.position);
      const double forth = (row < 3 ? there.displacement : there.rotation)[row % 3];
      const double back = (column < 3 ? here.displacement : here.rotation)[column % 3];
      EXPECT_NEAR(forth, back, 1e-12) << row << ' ' << column;
    }
  }
}

TEST(HalfSpaceFieldsTest, FarFromADiscItsExactFieldsAreMet) {
  // A flat punch pressed by d: u = (2 d/pi) asin(a/r) at r, force 2 E* a d; a bonded disc turned by
  // phi: u = (2 phi r/pi) [asin(a/r) - (a/r) sqrt(1 - a^2/r^2)], torque 16/3 G a^3 phi. At r = 30 a
  // the point load's field is off by (a/r)^2/6 and 3/10 (a/r)^2.
  const Elasticity elasticity = with_ratio(0.3);
  const double a = 1.0 / 30.0;
  const glm::dvec3 point = point_below(1.0, 0.0, 0.3);
  const Wrench pressed{-2.0 * elasticity.contact_modulus() * a * kLoad.normal, glm::dvec3(0.0)};
  const glm::dvec3 sunk = half_space_motion(kLoad, elasticity, pressed, point).displacement;
  EXPECT_NEAR(-glm::dot(sunk, kLoad.normal) / (2.0 / pi * std::asin(a)), 1.0, 5e-4);

  const Wrench turned{glm::dvec3(0.0),
                      16.0 / 3.0 * elasticity.shear_modulus() * a * a * a * kLoad.normal};
  const glm::dvec3 moved = half_space_motion(kLoad, elasticity, turned, point).displacement;
  const double exact = 2.0 / pi * (std::asin(a) - a * std::sqrt(1.0 - a * a));
  EXPECT_NEAR(glm::dot(moved, glm::cross(kLoad.normal, point - kLoad.position)) / exact, 1.0, 1e-3);
}

TEST(HalfSpaceFieldsTest, RotationIsHalfTheCurlAbovePlaneTooAndStaysContinuous) {
  // -0.6 is where R + z begins to be bent away from zero; there both sides must agree to the
  // distance of 1e-5 between them.
  const Elasticity elasticity = with_ratio(0.1);
  for (int row = 0; row < 6; ++row) {
    const Wrench wrench = unit_wrench(row);
    for (const double share : {-0.3, -0.59, -0.7, -0.95}) {
      const glm::dvec3 point = point_below(0.7, share, 1.0 + row);
      const glm::dmat3 g = gradient_of_displacement(elasticity, wrench, point, 7e-5);
      const glm::dvec3 curl(g[1][2] - g[2][1], g[2][0] - g[0][2], g[0][1] - g[1][0]);
      const glm::dvec3 rotation = half_space_motion(kLoad, elasticity, wrench, point).rotation;
      EXPECT_NEAR(glm::length(0.5 * curl - rotation), 0.0, 1e-5) << row << ' ' << share;
    }
    const MaterialMotion before =
        half_space_motion(kLoad, elasticity, wrench, point_below(0.7, -0.599995, 1.0));
    const MaterialMotion behind =
        half_space_motion(kLoad, elasticity, wrench, point_below(0.7, -0.600005, 1.0));
    EXPECT_LT(glm::length(before.displacement - behind.displacement), 1e-4) << row;
    EXPECT_LT(glm::length(before.rotation - behind.rotation), 1e-4) << row;
  }
}

TEST(HalfSpaceFieldsTest, AbovePlaneTheFieldGoesOnWithoutJumpOrPole) {
  const Elasticity elasticity = with_ratio(0.2);
  const glm::dvec3 above = kLoad.position + 0.5 * kLoad.normal;
  const glm::dvec3 aside = glm::cross(kLoad.normal, glm::dvec3(1.0, 0.0, 0.0));
  for (int row = 0; row < 6; ++row) {
    const MaterialMotion middle = half_space_motion(kLoad, elasticity, unit_wrench(row), above);
    const MaterialMotion beside =
        half_space_motion(kLoad, elasticity, unit_wrench(row), above + 1e-6 * aside);
    EXPECT_LT(glm::length(middle.displacement), 10.0);  // 4 pi G u is of order 1/R or 1/R^2
    EXPECT_LT(glm::length(middle.displacement - beside.displacement), 1e-4) << row;
  }
}

}  // namespace
}  // namespace torsion::engine
