#include <gtest/gtest.h>

#include "systems/math/frames.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUpright;

/// A motion that presses, slides and twists.
Pose pose_at(double t) {
  return {{0.002 * t, 0.15 + 2e-4 - 7e-4 * std::min(1.0, 3.0 * t), 0.001 * t},
          glm::angleAxis(0.8 * t, glm::normalize(glm::dvec3(0.1, 1.0, -0.05)))};
}

SceneDescription ellipsoid_on_cube() {
  SceneDescription scene = test::ball_on_cube();
  scene.tools[0] = test::make_tool({test::make_part(ShapeKind::kEllipsoid, {0.06, 0.05, 0.04})});
  return scene;
}

class InvarianceTest : public testing::TestWithParam<SceneDescription (*)()> {};

TEST_P(InvarianceTest, TheSceneTurnedAndShiftedGivesTheSameForcesTurned) {
  const Pose moved{{12.0, -7.0, 3.0},
                   glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, -0.5, 0.8)))};
  const SceneDescription scene = GetParam()();
  SceneDescription turned = scene;
  turned.bodies[0].pose = moved;
  Hand hand(scene);
  Hand hand_turned(turned);
  constexpr int kSteps = 300;
  for (int i = 0; i <= kSteps; ++i) {
    const Pose pose = pose_at(static_cast<double>(i) / kSteps);
    hand.step_to({pose});
    hand_turned.step_to({{to_outer(moved, pose.position), moved.rotation * pose.rotation}});
    // The bound for exact shapes, as a share of the wrench's size.
    const double force = glm::length(hand.wrench().force);
    const double torque = glm::length(hand.wrench().torque);
    EXPECT_LE(glm::length(moved.rotation * hand.wrench().force - hand_turned.wrench().force),
              1e-4 * force + 1e-9);
    EXPECT_LE(glm::length(moved.rotation * hand.wrench().torque - hand_turned.wrench().torque),
              1e-4 * torque + 1e-9);
  }
  EXPECT_GT(glm::length(hand.wrench().force), 1.0);
  EXPECT_GT(glm::length(hand.wrench().torque), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(ExactShapes, InvarianceTest,
                         testing::Values(test::ball_on_cube, ellipsoid_on_cube));

TEST(MeshInvarianceTest, ABallCutIntoTrianglesFeelsLikeTheExactBall) {
  SceneDescription meshed = test::ball_on_cube();
  meshed.tools[0] =
      test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(0.05), {}, true, 40)});
  Hand exact(test::ball_on_cube());
  Hand mesh(meshed);
  for (int i = 0; i <= 300; ++i) {
    exact.step_to({pose_at(i / 300.0)});
    mesh.step_to({pose_at(i / 300.0)});
  }
  // Facets of edge e = 2 mm are e^2 / (8 R) = 10 micrometres inside the sphere, 2 % of the depth;
  // the force goes with depth^1.5, the friction limit with it.
  EXPECT_NEAR(mesh.wrench().force.y, exact.wrench().force.y, 0.05 * exact.wrench().force.y);
  EXPECT_NEAR(mesh.wrench().torque.y, exact.wrench().torque.y,
              0.1 * std::abs(exact.wrench().torque.y));
}

}  // namespace
}  // namespace torsion::engine
