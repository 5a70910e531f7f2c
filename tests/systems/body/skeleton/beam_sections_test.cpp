#include "systems/body/skeleton/beam_sections.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/body/skeleton/skeleton.hpp"
#include "tests/systems/body_scene.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

std::vector<glm::dvec2> rectangle(double width, double height) {
  const double x = width / 2.0;
  const double y = height / 2.0;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

std::vector<glm::dvec2> ellipse(double a, double b, int corners) {
  std::vector<glm::dvec2> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    polygon.emplace_back(a * std::cos(angle), b * std::sin(angle));
  }
  return polygon;
}

TEST(PolygonMomentsTest, RectangleOffTheOriginHasItsMomentsAboutItsCentroid) {
  std::vector<glm::dvec2> polygon = rectangle(3.0, 2.0);
  for (glm::dvec2& corner : polygon) {
    corner += glm::dvec2(5.0, -7.0);
  }
  const PolygonMoments moments = polygon_moments(polygon);
  // Closed forms b h^3/12 and h b^3/12; the shift costs up to 1e3 units of rounding.
  EXPECT_NEAR(moments.area, 6.0, 1e-12);
  EXPECT_NEAR(moments.centroid.x, 5.0, 1e-12);
  EXPECT_NEAR(moments.centroid.y, -7.0, 1e-12);
  EXPECT_NEAR(moments.xx, 3.0 * 8.0 / 12.0, 1e-11);
  EXPECT_NEAR(moments.yy, 2.0 * 27.0 / 12.0, 1e-11);
  EXPECT_NEAR(moments.xy, 0.0, 1e-11);
}

TEST(PolygonMomentsTest, TriangleHasItsProductOfInertia) {
  // Right triangle with legs b, h along x and y: I_xy about the centroid is -b^2 h^2 / 72.
  const PolygonMoments moments = polygon_moments({{0.0, 0.0}, {2.0, 0.0}, {0.0, 3.0}});
  EXPECT_NEAR(moments.xy, -4.0 * 9.0 / 72.0, 1e-12);
  EXPECT_NEAR(moments.xx, 2.0 * 27.0 / 36.0, 1e-12);
}

TEST(TorsionConstantTest, CircleHasItsPolarMoment) {
  // A regular 96-gon has an area 7.1e-4 smaller than its circle, so J is 1.4e-3 smaller.
  EXPECT_NEAR(torsion_constant(ellipse(0.03, 0.03, 96)) / (pi * std::pow(0.03, 4) / 2.0), 1.0,
              2e-3);
}

TEST(TorsionConstantTest, EllipsesMatchTheClosedForm) {
  for (const double ratio : {1.5, 2.0, 4.0, 8.0}) {
    const double a = 0.1;
    const double b = a / ratio;
    const double exact = pi * a * a * a * b * b * b / (a * a + b * b);
    EXPECT_NEAR(torsion_constant(ellipse(a, b, 400)) / exact, 1.0, 5e-3) << "a/b = " << ratio;
  }
}

TEST(TorsionConstantTest, RectanglesMatchSaintVenantsSeries) {
  // J = (a b^3 / 3)(1 - (192/pi^5)(b/a) sum over odd n of tanh(n pi a / 2b) / n^5), a >= b.
  for (const double ratio : {1.0, 1.3, 2.0, 3.0, 5.0, 10.0}) {
    double sum = 0.0;
    for (int n = 1; n < 40; n += 2) {
      sum += std::tanh(n * pi * ratio / 2.0) / std::pow(n, 5);
    }
    const double exact = ratio / 3.0 * (1.0 - 192.0 / std::pow(pi, 5) / ratio * sum);
    const double j = torsion_constant(rectangle(ratio, 1.0));
    EXPECT_NEAR(j / exact, 1.0, 5e-4) << "a/b = " << ratio;
  }
}

TEST(TorsionConstantTest, TurnAndShiftOfTheSectionChangeNothing) {
  std::vector<glm::dvec2> polygon = rectangle(2.0, 1.0);
  const double before = torsion_constant(polygon);
  for (glm::dvec2& corner : polygon) {
    corner =
        glm::dvec2(0.6 * corner.x - 0.8 * corner.y + 3.0, 0.8 * corner.x + 0.6 * corner.y - 1.0);
  }
  EXPECT_NEAR(torsion_constant(polygon) / before, 1.0, 1e-9);
}

TEST(TransverseAxesTest, AreUnitPerpendicularAndRightHandedForEveryDirection) {
  const glm::dvec3 reference = glm::normalize(glm::dvec3(0.2, 1.0, -0.1));
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 direction =
        glm::normalize(glm::dvec3(std::sin(1.3 * i), std::cos(2.1 * i), std::sin(0.7 * i + 1.0)));
    const TransverseAxes axes = transverse_axes(direction, reference);
    EXPECT_NEAR(glm::length(axes.first), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(axes.first, direction), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(glm::cross(axes.first, axes.second) - direction), 0.0, 1e-12);
  }
}

TEST(TransverseAxesTest, TurnLittleWhenTheDirectionTurnsLittle) {
  const glm::dvec3 reference(0.0, 1.0, 0.0);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.7, 0.5, -0.3));
  const glm::dvec3 other = glm::normalize(direction + glm::dvec3(1e-6, -1e-6, 1e-6));
  EXPECT_LT(glm::length(transverse_axes(direction, reference).first -
                        transverse_axes(other, reference).first),
            1e-5);
}

TEST(BeamSpringTest, ASquareBarHasEAOverL) {
  const double side = 0.1;
  const World world =
      body_world(exact_body(ShapeKind::kBox, glm::dvec3(side / 2), FixedKind::kFace));
  const BeamSpring spring = beam_spring(main_beam(world.model, 0, {0.0, side / 2, 0.0}),
                                        world.model.bodies.at<Elasticity>(0));
  EXPECT_NEAR(spring.length, side, 1e-12);
  EXPECT_NEAR(spring.stiffness / (3e6 * side), 1.0, 5e-3);
}

}  // namespace
}  // namespace torsion::engine
