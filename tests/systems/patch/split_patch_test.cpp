// A contact that parts into two, or two that become one, go on with what they were: nothing but the
// tool's motion changes the force and the torque that friction holds.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"

namespace torsion::engine::test {
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

struct Event {
  BodyModel body;
  double change;  // of force and torque that a split or a merge may make
};

class SplitPatchTest : public testing::TestWithParam<Event> {
 protected:
  Hand hand{two_lobes(GetParam().body)};

  /// Presses the tool so deep, m, and turns it.
  void press_and_turn(double depth) {
    const glm::dvec3 up(0.0, 1.0, 0.0);
    hand.step_to({{glm::dvec3(0.0, 0.1205, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
    hand.move({0.0, -5e-4 - depth, 0.0}, up, 0.0, 500);
    hand.move(glm::dvec3(0.0), up, 0.1, 200);
  }

  /// Moves it by `shift` m a step until there are so many regions, and on.
  void expect_to_go_on(double shift, std::uint32_t regions) {
    constexpr std::size_t kBeside = 20;  // steps: what an event changes has faded by then
    std::vector<Wrench> wrenches;
    std::size_t event = 0;
    while (wrenches.size() < 2000 && (event == 0 || wrenches.size() <= event + kBeside)) {
      hand.move({0.0, shift, 0.0}, {0.0, 1.0, 0.0}, 0.0, 1);
      event = event == 0 && hand.world().state.regions.size() == regions ? wrenches.size() : event;
      wrenches.push_back(hand.wrench());
    }
    ASSERT_GT(event, kBeside);
    ASSERT_EQ(wrenches.size(), event + kBeside + 1);
    const auto is_continued = [&](const auto& value) {
      const double before = value(wrenches[event - kBeside]);
      const double at = value(wrenches[event - 1]);
      EXPECT_NEAR(value(wrenches[event + kBeside]), 2.0 * at - before,
                  GetParam().change * std::abs(at));
    };
    is_continued([](const Wrench& wrench) { return wrench.force.y; });
    is_continued([](const Wrench& wrench) { return wrench.torque.y; });
  }
};

TEST_P(SplitPatchTest, ForceAndTorqueGoOnWhereOneBecomesTwo) {
  press_and_turn(4.5e-3);
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  expect_to_go_on(2e-6, 2);
}

TEST_P(SplitPatchTest, ForceAndTorqueGoOnWhereTwoBecomeOne) {
  press_and_turn(2e-3);
  ASSERT_EQ(hand.world().state.regions.size(), 2U);
  expect_to_go_on(-2e-6, 1);
}

TEST_P(SplitPatchTest, GivesNoEnergyOverClosedPaths) {
  hand.step_to({{glm::dvec3(0.0, 0.1205, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move({0.0, -2.5e-3, 0.0}, {0.0, 1.0, 0.0}, 0.0, 500);
  for (int loop = 0; loop < 4; ++loop) {
    const double before = hand.world().state.tools.at<ToolWrench>(0).work;
    hand.move({0.0, -2.5e-3, 0.0}, {0.0, 1.0, 0.0}, 0.0, 300);
    EXPECT_EQ(hand.world().state.regions.size(), 1U);
    hand.move({0.0, 2.5e-3, 0.0}, {0.0, 1.0, 0.0}, 0.0, 300);
    EXPECT_EQ(hand.world().state.regions.size(), 2U);
    EXPECT_GE(hand.world().state.tools.at<ToolWrench>(0).work, before);
  }
}

// Balls whose middles are d = 22 mm apart, with contacts of a = 8 mm, move each other by 4 / (3 pi)
// a / d = 0.15 of what they do themselves (Johnson, Contact Mechanics, 1985, (3.22a) and 4.2): a
// quarter of the force, as F ~ depth^(3/2). That is what changes where regions do not see each
// other; with compliance they do as rigid bodies, which leaves out what changes across them, a / d
// of that. Without friction's history half of the torque would go.
INSTANTIATE_TEST_SUITE_P(Bodies, SplitPatchTest,
                         testing::Values(Event{BodyModel::kCompliance, 0.05},
                                         Event{BodyModel::kNone, 0.25}));

}  // namespace
}  // namespace torsion::engine::test
