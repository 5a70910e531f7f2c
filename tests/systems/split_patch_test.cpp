// A contact that parts into two goes on with what it was: nothing but the tool's motion changes
// the force and the torque that friction holds.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"

namespace torsion::test {
namespace {

/// Two balls side by side, one tool, over a cube.
SceneDescription two_lobes(BodyModel body) {
  SceneDescription scene = ball_on_cube();
  scene.bodies[0].elasticity = {1e5, 0.45, 1000.0};
  scene.bodies[0].friction = {0.9, 0.9};
  scene.bodies[0].models.contact = ContactModel::kPatch;
  scene.bodies[0].models.body = body;
  scene.bodies[0].models.region_threshold = 0.004;
  scene.tools[0] =
      make_tool({make_part(ShapeKind::kSphere, glm::dvec3(0.02), {{0.011, 0.0, 0.0}}),
                 make_part(ShapeKind::kSphere, glm::dvec3(0.02), {{-0.011, 0.0, 0.0}})});
  return scene;
}

struct Split {
  BodyModel body;
  double change;  // of force and torque that a split may make
};

class SplitPatchTest : public testing::TestWithParam<Split> {};

TEST_P(SplitPatchTest, ForceAndTorqueGoOn) {
  const glm::dvec3 up(0.0, 1.0, 0.0);
  Hand hand(two_lobes(GetParam().body));
  hand.step_to({{glm::dvec3(0.0, 0.1205, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move({0.0, -0.005, 0.0}, up, 0.0, 500);
  ASSERT_EQ(hand.world().regions.size(), 1U);
  hand.move(glm::dvec3(0.0), up, 0.1, 200);
  constexpr std::size_t kBeside = 20;  // steps: what an event changes has faded by then
  std::vector<Wrench> wrenches;
  std::size_t split = 0;
  while (wrenches.size() < 2000 && (split == 0 || wrenches.size() <= split + kBeside)) {
    hand.move({0.0, 2e-6, 0.0}, up, 0.0, 1);
    split = split == 0 && hand.world().regions.size() == 2 ? wrenches.size() : split;
    wrenches.push_back(hand.wrench());
  }
  ASSERT_GT(split, kBeside);
  ASSERT_EQ(wrenches.size(), split + kBeside + 1);
  const auto is_continued = [&](const auto& value) {
    const double before = value(wrenches[split - kBeside]);
    const double at = value(wrenches[split - 1]);
    EXPECT_NEAR(value(wrenches[split + kBeside]), 2.0 * at - before,
                GetParam().change * std::abs(at));
  };
  is_continued([](const Wrench& wrench) { return wrench.force.y; });
  is_continued([](const Wrench& wrench) { return wrench.torque.y; });
}

// Balls whose middles are d = 22 mm apart, with contacts of a = 8 mm, sink by each other's load 4 /
// (3 pi) a / d = 0.15 of what they do by their own (Johnson, Contact Mechanics, 1985, (3.22a) and
// 4.2): a quarter of the force, as F ~ depth^(3/2). That is what changes where regions do not see
// each other; with compliance they do as point loads, a tenth off. Without friction's history half
// of the torque would go.
INSTANTIATE_TEST_SUITE_P(Bodies, SplitPatchTest,
                         testing::Values(Split{BodyModel::kCompliance, 0.03},
                                         Split{BodyModel::kNone, 0.25}));

}  // namespace
}  // namespace torsion::test
