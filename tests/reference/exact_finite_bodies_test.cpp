#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/reference/airy_layer.hpp"
#include "tests/reference/exact/bars.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/layers.hpp"
#include "tests/reference/exact/materials.hpp"
#include "tests/reference/exact/quadrature.hpp"
#include "tests/reference/printed_number.hpp"

namespace torsion::engine::reference {
namespace {

using std::numbers::pi;

Layer rubber_layer(double thickness, LayerBase base = LayerBase::kBonded, double poisson = 0.5) {
  return {base, thickness, poisson, contact_modulus(3e6, poisson)};
}

TEST(LayerTorsionTest, MatchesPrintedRatios) {
  const double thickness[] = {0.05, 0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0};
  const double printed[] = {6.42737,  3.49875,  1.778792, 1.258148, 1.116812, 1.061553,
                            1.022512, 1.010401, 1.003316, 1.000747, 1.000095};
  const int digits[] = {6, 6, 7, 7, 7, 7, 7, 7, 7, 7, 7};
  for (int i = 0; i < 11; ++i) {
    EXPECT_TRUE(rounds_to(layer_torsion_ratio(thickness[i]), printed[i], digits[i]))
        << thickness[i];
  }
}

TEST(LayerTorsionTest, ReachesThickAndThinLimits) {
  // 1 + eta(3) / (3 pi) (a/h)^3, the next term (a/h)^5.
  const double eta = 0.75 * std::riemann_zeta(3.0);
  for (const double thickness : {20.0, 50.0}) {
    const double excess = layer_torsion_ratio(thickness) - 1.0;
    const double leading = eta / (3.0 * pi) * std::pow(thickness, -3);
    EXPECT_NEAR(excess / leading, 1.0, 2.0 / (thickness * thickness)) << thickness;
  }
  // T = (G pi phi / 2 h) (a + (2 ln 2 / pi) h)^4, with an error of the order of (h/a)^2.
  for (const double thickness : {0.02, 0.05}) {
    const double edge = 1.0 + 2.0 * std::log(2.0) / pi * thickness;
    const double thin = pi / (2.0 * thickness) * std::pow(edge, 4) / (16.0 / 3.0);
    EXPECT_NEAR(layer_torsion_ratio(thickness) / thin, 1.0, 2.0 * thickness * thickness)
        << thickness;
  }
}

/// L of a bonded or frictionless layer, plane strain (the same as axisymmetric), from its boundary
/// conditions.
double compliance_from_boundaries(LayerBase base, double poisson, double u) {
  const AiryRows bottom = airy_rows(poisson, 0.0);
  const AiryRows top = airy_rows(poisson, u);
  Eigen::Matrix4d conditions;
  conditions.row(0) = bottom.normal;
  conditions.row(1) = base == LayerBase::kBonded ? bottom.sideways : bottom.slope;  // or no shear
  conditions.row(2) = top.slope;                                                    // no shear
  conditions.row(3) = top.phi;  // sigma_zz = -phi
  const Eigen::Vector4d coefficients =
      conditions.fullPivLu().solve(Eigen::Vector4d(0.0, 0.0, 0.0, 1.0));
  // Pressure 1: into the body by -u_z; on a half-space by 2 / (E* k) with E* = 2 G / (1 - nu).
  return -top.normal.dot(coefficients) / (2.0 * (1.0 - poisson));
}

TEST(LayerComplianceTest, FollowsFromTheBoundaryConditions) {
  for (const double poisson : {0.0, 0.3, 0.5}) {
    for (const double u : {0.3, 1.0, 3.0}) {
      for (const LayerBase base : {LayerBase::kBonded, LayerBase::kFrictionless}) {
        EXPECT_NEAR(layer_compliance_ratio(base, poisson, u),
                    compliance_from_boundaries(base, poisson, u), 1e-12)
            << poisson << " " << u;
      }
    }
  }
}

TEST(LayerSphereTest, MatchesPrintedForces) {
  // The table is in chi = sqrt(R depth) / h.
  const double depth = 4e-4;
  const double contact = std::sqrt(0.05 * depth);
  const double chi[] = {0.0227, 0.0454, 0.1, 0.2, 0.5};
  const double bonded[] = {1.026363, 1.054360, 1.129082, 1.297946, 2.156215};
  const double frictionless[] = {1.017209, 1.035106, 1.081114, 1.177094, 1.566845};
  for (int i = 0; i < 5; ++i) {
    const double h = contact / chi[i];
    const Layer glued = rubber_layer(h);
    const Layer lubricated = rubber_layer(h, LayerBase::kFrictionless);
    EXPECT_TRUE(rounds_to(layer_sphere_at_depth(glued, 0.05, depth).hertz_ratio, bonded[i], 7));
    EXPECT_TRUE(
        rounds_to(layer_sphere_at_depth(lubricated, 0.05, depth).hertz_ratio, frictionless[i], 7));
  }
}

TEST(LayerSphereTest, ThickLayerIsAHalfSpace) {
  for (const LayerBase base : {LayerBase::kBonded, LayerBase::kFrictionless}) {
    const LayerContact contact = layer_sphere_at_depth(rubber_layer(50.0, base), 0.05, 4e-4);
    const HertzSphere hertz = hertz_sphere_at_depth(0.05, 4e6, 4e-4);
    // 1 + 1.133 a / h, a / h = 9e-5.
    EXPECT_NEAR(contact.hertz_ratio, 1.0, 1.2e-4);
    EXPECT_NEAR(contact.radius / hertz.radius, 1.0, 1e-4);
    EXPECT_NEAR(contact.stiffness / hertz.stiffness, 1.0, 2e-4);
  }
  EXPECT_NEAR(layer_sphere_at_depth(rubber_layer(5.0), 0.05, 4e-4).hertz_ratio,
              1.0 + 1.133 * std::sqrt(0.05 * 4e-4) / 5.0, 1e-5);
}

TEST(LayerSphereTest, StiffnessIsTheSlopeOfTheForce) {
  // A little more depth presses the contact area like a flat punch: the new rim carries nothing
  // yet.
  for (const double poisson : {0.0, 0.3, 0.5}) {
    const Layer layer = rubber_layer(0.01, LayerBase::kBonded, poisson);
    const double depth = 4e-4;
    const double h = 1e-4 * depth;
    const double slope = (layer_sphere_at_depth(layer, 0.05, depth + h).force -
                          layer_sphere_at_depth(layer, 0.05, depth - h).force) /
                         (2.0 * h);
    EXPECT_NEAR(layer_sphere_at_depth(layer, 0.05, depth).stiffness / slope, 1.0, 1e-7) << poisson;
  }
}

TEST(LayerSphereTest, CompressibleFilmIsAFoundationOfSprings) {
  // a >> h: p = w E (1 - nu) / ((1 + nu)(1 - 2 nu) h), F = pi k R depth^2, with an edge of the
  // width h.
  const double young = 3e6;
  const double poisson = 0.2;
  const Layer film = rubber_layer(1e-4, LayerBase::kBonded, poisson);
  const double confined = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  const LayerContact contact = layer_sphere_at_radius(film, 0.05, 50.0 * film.thickness);
  const double springs = pi * confined / film.thickness * 0.05 * contact.depth * contact.depth;
  EXPECT_NEAR(contact.force / springs, 1.0, 0.03);
  EXPECT_NEAR(contact.radius * contact.radius / (2.0 * 0.05 * contact.depth), 1.0, 0.03);
}

TEST(BarsTest, MatchPrintedTorques) {
  const auto round_bar = [](double g, double r, double length, double twist) {
    return bar_torque(g, circle_torsion_constant(r), length, twist);
  };
  EXPECT_TRUE(rounds_to(round_bar(1e6, 0.05, 0.1, 0.1), 9.81747704, 9));
  EXPECT_TRUE(rounds_to(round_bar(1e6, 0.02, 0.2, 0.05), 6.28318531e-2, 9));
  EXPECT_TRUE(rounds_to(round_bar(2e5, 0.03, 0.15, 0.2), 3.39292007e-1, 9));
  const auto square_bar = [](double g, double side, double length, double twist) {
    return bar_torque(g, rectangle_torsion_constant(side, side), length, twist);
  };
  EXPECT_TRUE(rounds_to(square_bar(1e6, 0.1, 0.1, 0.01), 1.40577015, 9));
  EXPECT_TRUE(rounds_to(square_bar(1e6, 0.1, 0.2, 0.01), 0.702885075, 9));
  EXPECT_TRUE(rounds_to(square_bar(2e5, 0.05, 0.2, 0.05), 4.39303172e-2, 9));
}

TEST(BarsTest, RectanglesMatchPrintedConstants) {
  EXPECT_TRUE(rounds_to(rectangle_torsion_constant(1.0, 1.0), 0.14057701, 8));
  EXPECT_TRUE(rounds_to(rectangle_torsion_constant(2.0, 1.0) / 2.0, 0.228682, 6));
  EXPECT_TRUE(rounds_to(rectangle_torsion_constant(1.0, 10.0) / 10.0, 0.312325, 6));
}

TEST(BarsTest, LargestShearMatchesTimoshenkosTable) {
  // Largest shear over G twist_rate times the shorter side, Timoshenko and Goodier, section 109.
  const double ratios[] = {1.0, 2.0, 3.0};
  const double printed[] = {0.675, 0.930, 0.985};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(rectangle_largest_shear(1.0, ratios[i], 1.0, 1.0), printed[i], 0.51e-3)
        << ratios[i];
  }
  EXPECT_EQ(rectangle_largest_shear(2.0, 0.3, 0.1, 0.5),
            rectangle_largest_shear(2.0, 0.1, 0.3, 0.5));
}

TEST(BarsTest, RectanglesAgreeWithPrandtlsDoubleSeries) {
  // J = 4 int phi with phi of laplacian -1... in sines of both sides: the tail beyond 999 is under
  // 1e-9.
  for (const double side : {1.0, 1.7}) {
    double sum = 0.0;
    for (int m = 999; m > 0; m -= 2) {
      for (int n = 999; n > 0; n -= 2) {
        const double m2 = m * m;
        const double n2 = n * n;
        sum += 1.0 / (m2 * n2 * (m2 / (side * side) + n2));
      }
    }
    EXPECT_NEAR(rectangle_torsion_constant(side, 1.0), 256.0 / std::pow(pi, 6) * side * sum, 1e-8);
  }
}

TEST(BarsTest, ConesMatchPrintedTwistsAndTheSumOfSlices) {
  EXPECT_TRUE(rounds_to(cone_twist(0.1, 1e6, 0.1, 0.02, 0.04), 1.16050479e-2, 9));
  EXPECT_TRUE(rounds_to(cone_twist(0.1, 1e6, 0.1, 0.005, 0.05), 3.76878905e-1, 9));
  EXPECT_TRUE(rounds_to(cone_twist(1.0, 1e6, 0.2, 0.03, 0.03), 1.57190067e-1, 9));
  const double slices = integrate_tanh_sinh(
      [](double z, double, double) {
        return 0.1 / (1e6 * circle_torsion_constant(0.02 + 0.02 * z / 0.1));
      },
      0.0, 0.1);
  EXPECT_NEAR(cone_twist(0.1, 1e6, 0.1, 0.02, 0.04) / slices, 1.0, 1e-12);
}

}  // namespace
}  // namespace torsion::engine::reference
