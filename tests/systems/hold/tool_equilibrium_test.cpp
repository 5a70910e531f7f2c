#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/hold/tool_hold.hpp"
#include "systems/math/frames.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kUnlimited;

PrepareOptions half_space(ContactModel model) {
  PrepareOptions options;
  options.contact_model = model;
  options.body_model = BodyModel::kNone;
  return options;
}

/// Holds the handle still until the tool has settled. @return steps to when it moved under 1 nm
int settle(test::Hand& hand, const VirtualCoupling& coupling, const Pose& handle, int most) {
  for (int i = 0; i < most; ++i) {
    const Pose next = next_tool_pose(hand.world().model, hand.world().state, 0, coupling, handle);
    const double moved =
        glm::distance(next.position, hand.world().state.tools.at<ToolPose>(0).now.position);
    hand.step_to({next});
    if (i > 0 && moved < 1e-9) {
      return i;
    }
  }
  return most;
}

TEST(ToolEquilibriumTest, OffEveryContactTheToolIsWhereTheHandleIs) {
  test::Hand hand(test::ball_on_cube(), half_space(ContactModel::kMdr));
  hand.step_to({{{0.0, 0.16, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  const Pose handle{{0.001, 0.159, 0.0}, glm::angleAxis(0.05, glm::dvec3(0.0, 1.0, 0.0))};
  const Pose next = next_tool_pose(hand.world().model, hand.world().state, 0,
                                   {500.0, 0.0, 1.0, 0.0, 5.0, 0.1}, handle);
  EXPECT_EQ(next.position, handle.position);
  EXPECT_EQ(next.rotation, handle.rotation);
}

TEST(ToolEquilibriumTest, CouplingAndContactAreInSeries) {
  // The handle feels K k / (K + k) less than the contact is stiff: by force balance and Hertz.
  for (const ContactModel model :
       {ContactModel::kMdr, ContactModel::kPatch, ContactModel::kPaper}) {
    test::Hand hand(test::ball_on_cube(), half_space(model));
    const VirtualCoupling coupling{2000.0, 0.0, 5.0, 0.0, kUnlimited, kUnlimited};
    Pose handle{{0.0, 0.1501, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
    hand.step_to({handle});
    for (int i = 0; i < 100; ++i) {
      handle.position.y -= 3e-5;
      hand.step_to({next_tool_pose(hand.world().model, hand.world().state, 0, coupling, handle)});
    }
    EXPECT_LT(settle(hand, coupling, handle, 100), 100);
    const double pulled =
        coupling.stiffness *
        (hand.world().state.tools.at<ToolPose>(0).now.position.y - handle.position.y);
    EXPECT_GT(hand.wrench().force.y, 1.0);
    EXPECT_NEAR(pulled, hand.wrench().force.y, 1e-3 * hand.wrench().force.y);
  }
}

TEST(ToolEquilibriumTest, SettlesInTurningToo) {
  test::Hand hand(test::ball_on_cube(), half_space(ContactModel::kMdr));
  const VirtualCoupling coupling{2000.0, 0.0, 0.5, 0.0, kUnlimited, kUnlimited};
  Pose handle{{0.0, 0.1501, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  hand.step_to({handle});
  for (int i = 0; i < 100; ++i) {
    handle.position.y -= 3e-5;
    hand.step_to({next_tool_pose(hand.world().model, hand.world().state, 0, coupling, handle)});
  }
  for (int i = 1; i <= 100; ++i) {
    handle.rotation = glm::angleAxis(5e-4 * i, glm::dvec3(0.0, 1.0, 0.0));
    hand.step_to({next_tool_pose(hand.world().model, hand.world().state, 0, coupling, handle)});
  }
  EXPECT_LT(settle(hand, coupling, handle, 200), 200);
  const Wrench pull =
      coupling_wrench(coupling, {handle}, {hand.world().state.tools.at<ToolPose>(0).now});
  EXPECT_GT(pull.torque.y, 1e-3);
  EXPECT_NEAR(-hand.wrench().torque.y, pull.torque.y, 1e-3 * pull.torque.y);
}

TEST(ToolEquilibriumTest, GoesNoFasterThanContactsCanBeFound) {
  test::Hand hand(test::ball_on_cube(), half_space(ContactModel::kMdr));
  hand.step_to({{{0.0, 0.1495, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.step_to({{{0.0, 0.1495, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  const Pose far{{0.0, -1.0, 0.0}, glm::angleAxis(3.0, glm::dvec3(0.0, 1.0, 0.0))};
  const Pose next = next_tool_pose(hand.world().model, hand.world().state, 0,
                                   {1e6, 0.0, 1e3, 0.0, kUnlimited, kUnlimited}, far);
  EXPECT_LE(glm::distance(next.position, {0.0, 0.1495, 0.0}), 1.0001e-3);
  EXPECT_LE(glm::length(turn_between(glm::dquat(1.0, 0.0, 0.0, 0.0), next.rotation)), 0.0200001);
}

}  // namespace
}  // namespace torsion::engine
