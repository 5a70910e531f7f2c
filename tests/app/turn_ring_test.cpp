#include "app/view/turn_ring.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

constexpr glm::dvec2 kWholeWindow(1280.0, 720.0);
constexpr double kRightAngle = 0.5 * std::numbers::pi;

/// About an axis that leans.
TurnRing leaning_ring() {
  TurnRing ring;
  ring.center = {0.02, 0.03, -0.01};
  ring.axis = glm::normalize(glm::dvec3(0.2, 1.0, 0.1));
  ring.tangent = glm::normalize(glm::cross(ring.axis, glm::dvec3(0.0, 0.0, 1.0)));
  ring.radius = 0.05;
  return ring;
}

Camera ring_camera(double azimuth, double elevation) {
  OrbitCamera camera;
  camera.target = {0.01, 0.0, 0.0};
  camera.distance = 0.4;
  camera.azimuth = azimuth;
  camera.elevation = elevation;
  return camera_of(camera);
}

glm::dvec2 seen_on(const TurnRing& ring, double angle, const Camera& camera) {
  return glm::dvec2(seen_at(camera, ring.at(angle), kWholeWindow));
}

TEST(TurnRingTest, ThePlaceTakenStaysUnderTheMouse) {
  const TurnRing ring = leaning_ring();
  for (const double azimuth : {0.0, 1.3, -2.6}) {
    for (const double elevation : {0.5, 1.2, -0.9}) {
      const Camera camera = ring_camera(azimuth, elevation);
      double all = 0.0;
      for (int i = 0; i < 24; ++i) {
        const double step = std::numbers::pi / 12.0;
        const double angle = i * step;
        const double turned = turned_by(ring, angle, camera, seen_on(ring, angle, camera),
                                        seen_on(ring, angle + step, camera), kWholeWindow);
        EXPECT_NEAR(turned, step, 1e-9);
        all += turned;
      }
      EXPECT_NEAR(all, 2.0 * std::numbers::pi, 1e-8);  // round and round, without a jump
    }
  }
}

TEST(TurnRingTest, FromItsEdgeTheMouseTurnsItsNearSideAlong) {
  TurnRing ring;
  ring.radius = 0.05;
  const Camera camera = ring_camera(0.0, 0.0);
  const double front = -kRightAngle;  // of x toward -z: +z is nearest to the eye
  const double step = 0.02;
  const double turned = turned_by(ring, front, camera, seen_on(ring, front, camera),
                                  seen_on(ring, front + step, camera), kWholeWindow);
  EXPECT_NEAR(turned, step, 0.01 * step);
  // At its end it goes toward the eye: the mouse along it or across it turns it by no leap.
  for (const glm::dvec2& way : {glm::dvec2(10.0, 0.0), glm::dvec2(0.0, 10.0)}) {
    const glm::dvec2 end = seen_on(ring, 0.0, camera);
    EXPECT_LT(std::abs(turned_by(ring, 0.0, camera, end, end + way, kWholeWindow)), 0.5);
  }
}

TEST(TurnRingTest, IsTakenWhereItIsSeenAndWhereItIsNearer) {
  TurnRing ring;
  ring.radius = 0.05;
  const Camera level = ring_camera(0.0, 0.0);
  const auto taken = angle_on(ring, level, seen_on(ring, -kRightAngle, level), kWholeWindow, 9.0);
  ASSERT_TRUE(taken.has_value());
  EXPECT_NEAR(std::remainder(*taken + kRightAngle, 2.0 * std::numbers::pi), 0.0, 0.3);
  EXPECT_GT(ring.at(*taken).z, 0.0);
  EXPECT_FALSE(angle_on(ring, level, {100.0, 100.0}, kWholeWindow, 9.0).has_value());
  // Seen whole, its middle is not it.
  const Camera above = ring_camera(0.0, 1.4);
  EXPECT_FALSE(angle_on(ring, above, glm::dvec2(seen_at(above, ring.center, kWholeWindow)),
                        kWholeWindow, 9.0)
                   .has_value());
  // Behind the eye there is none.
  Camera beyond = level;
  beyond.pose.position.z = -0.3;
  EXPECT_FALSE(angle_on(ring, beyond, {640.0, 360.0}, kWholeWindow, 400.0).has_value());
}

TEST(TurnRingTest, GoesAroundTheTool) {
  const Bounds bounds{{-0.01, -0.04, -0.01}, {0.01, 0.04, 0.01}};
  Pose pose;
  pose.position = {0.1, 0.2, 0.3};
  pose.rotation = glm::angleAxis(0.3, glm::dvec3(0.0, 1.0, 0.0));
  const glm::dvec3 up(0.0, 1.0, 0.0);
  const TurnRing ring = ring_around(pose, bounds, {0.1, 0.15, 0.3}, up, {1.0, 0.0, 0.0});
  EXPECT_NEAR(ring.radius, 0.016, 1e-12);
  EXPECT_LT(glm::length(ring.center - pose.position), 1e-12);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(glm::length(ring.at(i) - ring.center), ring.radius, 1e-12);
    EXPECT_NEAR(glm::dot(ring.at(i) - ring.center, up), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace torsion::engine
