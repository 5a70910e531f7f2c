#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;
using test::kUpright;

/// A motion of tool 0 over the time 0 to 1.
using Path = std::function<Pose(double)>;

struct Jump {
  double force = 0.0;   // N, largest change in a step
  double torque = 0.0;  // N m
  double most_force = 0.0;
  double most_torque = 0.0;
  std::uint64_t regions_formed = 0;
};

/// Walks the path in `duration` seconds at a rate of 1/dt; what an event fades in takes a fixed
/// time, so the finer the steps the smaller a jump must be.
Jump largest_jump(const SceneDescription& scene, const Path& path, int steps, double duration) {
  PrepareOptions options;
  options.rate = steps / duration;
  Hand hand(scene, options);
  hand.step_to({path(0.0)});
  Jump jump;
  Wrench before = hand.wrench();
  for (int i = 1; i <= steps; ++i) {
    hand.step_to({path(static_cast<double>(i) / steps)});
    jump.force = std::max(jump.force, glm::length(hand.wrench().force - before.force));
    jump.torque = std::max(jump.torque, glm::length(hand.wrench().torque - before.torque));
    before = hand.wrench();
    jump.most_force = std::max(jump.most_force, glm::length(before.force));
    jump.most_torque = std::max(jump.most_torque, glm::length(before.torque));
  }
  jump.regions_formed = hand.clock().regions_formed;
  EXPECT_EQ(hand.clock().faults_ever, 0U);
  return jump;
}

/// Ten times finer steps must make the largest jump at least four times smaller, and small: what an
/// event changed, at most the whole wrench, fades within 10 ms, and the motion adds its own.
void expect_continuous(const SceneDescription& scene, const Path& path, double duration,
                       std::uint64_t regions) {
  const Jump coarse = largest_jump(scene, path, 400, duration);
  const Jump fine = largest_jump(scene, path, 4000, duration);
  EXPECT_EQ(fine.regions_formed, regions);
  EXPECT_LT(fine.force, coarse.force / 4.0);
  const double fade_per_step = duration / 4000.0 / 0.01;
  EXPECT_LT(fine.force, (fade_per_step + 0.02) * fine.most_force);
  EXPECT_LT(fine.torque, coarse.torque / 4.0);
  EXPECT_LT(fine.torque, (fade_per_step + 0.02) * fine.most_torque);
}

SceneDescription slab_with_feet(const std::vector<glm::dvec3>& places, double radius) {
  SceneDescription scene;
  scene.bodies.push_back(test::make_body({test::make_part(
      ShapeKind::kBox, {0.15, 0.05, 0.15}, {glm::dvec3(0.0, -0.05, 0.0), kUpright})}));
  std::vector<PartDescription> parts;
  for (const glm::dvec3& place : places) {
    parts.push_back(test::make_part(ShapeKind::kSphere, glm::dvec3(radius),
                                    {place + glm::dvec3(0.0, radius, 0.0), kUpright}, false, 8));
  }
  scene.tools.push_back(test::make_tool(std::move(parts)));
  return scene;
}

Pose at(const glm::dvec3& position, double turn = 0.0) {
  return {position, glm::angleAxis(turn, kUp)};
}

TEST(ContinuityTest, RegionFormsAndDies) {
  const Path down_and_up = [](double t) {
    return at({1e-3 * t, 1e-4 - 6e-4 * std::sin(3.14159265 * t), 0.0}, 0.4 * t);
  };
  expect_continuous(slab_with_feet({{0.0, 0.0, 0.0}}, 0.02), down_and_up, 1.0, 1);
}

TEST(ContinuityTest, SecondRegionFormsWhileTheFirstIsTwisted) {
  // The first foot is under the mass centre: the axis goes through it, and the second contact makes
  // (14) hold.
  const Path press = [](double t) {
    return at({0.0, -3e-4 - 3e-4 * t, 0.0}, 0.5 * t);
  };
  expect_continuous(slab_with_feet({{0.0, 0.0, 0.0}, {0.05, 4.5e-4, 0.0}}, 0.02), press, 1.0, 2);
}

TEST(ContinuityTest, RegionsMergeAndSplit) {
  SceneDescription scene = slab_with_feet({{-0.008, 0.0, 0.0}, {0.008, 2e-5, 0.0}}, 0.02);
  const Path press = [](double t) {
    return at({0.0, 1e-4 - 2.6e-3 * std::sin(3.14159265 * t), 0.0}, 0.1 * t);
  };
  expect_continuous(scene, press, 2.0, 3);
}

class HalfSpaceContinuityTest : public testing::TestWithParam<ContactModel> {
 protected:
  /// Two feet side by side, the second a little higher, over a body with the model in question.
  [[nodiscard]] static SceneDescription scene(std::vector<glm::dvec3> places) {
    SceneDescription scene = slab_with_feet(places, 0.02);
    scene.bodies[0].models.contact = GetParam();
    scene.bodies[0].models.body = BodyModel::kNone;
    return scene;
  }
};

TEST_P(HalfSpaceContinuityTest, RegionFormsAndDies) {
  const Path down_and_up = [](double t) {
    return at({1e-3 * t, 1e-4 - 6e-4 * std::sin(3.14159265 * t), 0.0}, 0.4 * t);
  };
  expect_continuous(scene({{0.0, 0.0, 0.0}}), down_and_up, 1.0, 1);
}

TEST_P(HalfSpaceContinuityTest, RegionsMeetAndPart) {
  const Path press = [](double t) {
    return at({0.0, 1e-4 - 2.6e-3 * std::sin(3.14159265 * t), 0.0}, 0.1 * t);
  };
  expect_continuous(scene({{-0.008, 0.0, 0.0}, {0.008, 2e-5, 0.0}}), press, 2.0, 3);
}

/// Presses the feet into a body that deflects until they meet, and lets go.
void expect_continuous_meeting(SceneDescription scene, std::uint64_t regions) {
  scene.bodies[0].models.body = BodyModel::kCompliance;
  const Path press = [](double t) {
    return at({0.0, 1e-4 - 2.6e-3 * std::sin(3.14159265 * t), 0.0}, 0.1 * t);
  };
  expect_continuous(scene, press, 2.0, regions);
}

TEST_P(HalfSpaceContinuityTest, RegionsMeetAndPartOnABodyThatGivesWay) {
  // Where two support fits become one, so do the body's answers to them.
  expect_continuous_meeting(scene({{-0.008, 0.0, 0.0}, {0.008, 2e-5, 0.0}}), 3);
}

TEST_P(HalfSpaceContinuityTest, ThirdFootStandsByWhereTwoMeetAndPart) {
  if (test::is_left_out(GetParam() == ContactModel::kMdr)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  // What the two change in the body moves the third, too.
  expect_continuous_meeting(scene({{-0.008, 0.0, 0.0}, {0.008, 2e-5, 0.0}, {0.0, 0.0, 0.03}}), 4);
}

INSTANTIATE_TEST_SUITE_P(Models, HalfSpaceContinuityTest,
                         testing::Values(ContactModel::kMdr, ContactModel::kPatch));

TEST(ContinuityTest, AxisEntersAndLeavesTheRegion) {
  // The tool's mass centre passes over the contact while it turns: the foot is not under the mass
  // centre, the tool moves so that the foot stays where it is.
  SceneDescription scene = slab_with_feet({{0.0, 0.0, 0.0}}, 0.02);
  scene.tools[0].mass.center = {0.006, 0.02, 0.0};
  const Path turn = [](double t) {
    // About the foot at first, then about the mass centre: the axis wanders through the region.
    const double angle = 0.6 * t;
    const double arm = 0.006 * t;
    const double depth = 5e-4 * std::min(1.0, 5.0 * t) - 1e-4;
    return at({arm * (1.0 - std::cos(angle)), -depth, arm * std::sin(angle)}, angle);
  };
  expect_continuous(scene, turn, 1.0, 1);
}

}  // namespace
}  // namespace torsion::engine
