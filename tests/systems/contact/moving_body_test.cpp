// Bodies that an animation moves. Nothing but the motion of the tool over the body may count: where
// both move as one besides, the wrench moves with them.

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "ecs/model_names.hpp"
#include "systems/math/frames.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/test_cache.hpp"

namespace torsion::engine {
namespace {

using test::Hand;

constexpr double kSeconds = 0.6;
constexpr double kRate = 1000.0;
const glm::dvec3 kVertical(0.0, 1.0, 0.0);

Pose product(const Pose& outer, const Pose& inner) {
  return {to_outer(outer, inner.position), outer.rotation * inner.rotation};
}

Pose inverse(const Pose& pose) {
  const glm::dquat back = glm::conjugate(pose.rotation);
  return {-(back * pose.position), back};
}

glm::dvec4 xyzw(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}

/// Down by 2 mm in 0.2 s, then turned by 12 degrees and slid by 1 mm, over a cube at rest.
Pose tool_at(double time) {
  const double down = std::min(time / 0.2, 1.0);
  const double turned = std::max(0.0, std::min((time - 0.2) / 0.3, 1.0));
  return {{1e-3 * turned, 0.1 + 0.05 + 2e-4 - 2.2e-3 * down, 0.0},
          glm::angleAxis(glm::radians(12.0) * turned, kVertical)};
}

struct Models {
  ContactModel contact;
  BodyModel body;
};

PrepareOptions options_of(const Models& models) {
  PrepareOptions options;
  options.contact_model = models.contact;
  options.body_model = models.body;
  options.rate = kRate;
  options.use_cache = test::has_test_cache();
  return options;
}

/// From the frame in which the body rests to the world in which it moves, as a script of the body.
struct Carriage {
  MotionScript script;
  Pose rest;

  [[nodiscard]] Pose at(double time) const {
    return product(scripted_pose(script, time), inverse(rest));
  }
};

Carriage carriage(const Pose& rest, std::vector<double> times, const std::vector<Pose>& poses) {
  MotionLink link;
  link.animated_translation.times = times;
  link.animated_rotation.times = std::move(times);
  for (const Pose& pose : poses) {
    link.animated_translation.values.emplace_back(pose.position, 0.0);
    link.animated_rotation.values.push_back(xyzw(pose.rotation));
  }
  Carriage made;
  made.script.end_time = link.animated_translation.times.back();
  made.script.links = {link};
  made.rest = rest;
  return made;
}

class MovingBodyTest : public testing::TestWithParam<Models> {
 protected:
  /// Runs a cube at rest beside one that is carried, with its tool, and compares at each step.
  static void expect_carried(const Carriage& carried, double tolerance) {
    const SceneDescription still = test::ball_on_cube();
    SceneDescription moving = still;
    moving.bodies[0].script = carried.script;
    Hand a(still, options_of(GetParam()));
    Hand b(moving, options_of(GetParam()));
    double force = 0.0;
    double torque = 0.0;
    for (int step = 0; step < static_cast<int>(kSeconds * kRate); ++step) {
      const double time = step / kRate;
      const Pose to_world = carried.at(time);
      const Pose tool = tool_at(time);
      a.step_to({tool});
      b.step_to({product(to_world, tool)});
      ASSERT_EQ(a.clock().faults, b.clock().faults) << "at " << time << " s";
      const Wrench& at_rest = a.wrench();
      const Wrench& in_world = b.wrench();
      force = std::max(force, glm::length(at_rest.force));
      torque = std::max(torque, glm::length(at_rest.torque));
      ASSERT_LT(glm::length(in_world.force - to_world.rotation * at_rest.force),
                tolerance * force + 1e-9)
          << "at " << time << " s";
      ASSERT_LT(glm::length(in_world.torque - to_world.rotation * at_rest.torque),
                tolerance * std::max(torque, 1e-3 * force) + 1e-9)
          << "at " << time << " s";
      ASSERT_EQ(a.world().state.regions.size(), b.world().state.regions.size());
    }
    EXPECT_GT(force, 1.0);
    EXPECT_GT(torque, 1e-3);
  }
};

// The same arithmetic in other axes: what is left is rounding, which friction's thresholds may
// carry on for a step or two.
constexpr double kRounding = 1e-6;

TEST_P(MovingBodyTest, CarriedAnywhereTheWrenchIsCarriedAlong) {
  const Pose rest = test::ball_on_cube().bodies[0].pose;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 0.4, -0.7));
  const Pose first{{0.3, -0.2, 0.5}, glm::angleAxis(0.8, axis)};
  const Pose second{{0.35, -0.1, 0.42}, glm::angleAxis(1.3, axis)};
  const Pose third{{0.2, -0.15, 0.4},
                   glm::angleAxis(-0.4, glm::normalize(glm::dvec3(0.2, -1.0, 0.6)))};
  expect_carried(carriage(rest, {0.0, 0.3, 0.6}, {first, second, third}), kRounding);
}

TEST_P(MovingBodyTest, TurnedUnderATool) {
  // As a jar's lid under a fingertip: about the vertical through the contact, 60 degrees.
  const Pose rest = test::ball_on_cube().bodies[0].pose;
  std::vector<double> times;
  std::vector<Pose> poses;
  for (int key = 0; key <= 6; ++key) {
    times.push_back(0.1 * key);
    const glm::dquat turned = glm::angleAxis(glm::radians(10.0) * key, kVertical);
    poses.push_back({turned * rest.position, turned * rest.rotation});
  }
  expect_carried(carriage(rest, times, poses), kRounding);
}

std::string name_of_models(const testing::TestParamInfo<Models>& info) {
  return std::string(name_of(info.param.contact)) + "_" + std::string(name_of(info.param.body));
}

INSTANTIATE_TEST_SUITE_P(Models, MovingBodyTest,
                         testing::Values(Models{ContactModel::kPaper, BodyModel::kSkeleton},
                                         Models{ContactModel::kPaper, BodyModel::kCompliance},
                                         Models{ContactModel::kMdr, BodyModel::kNone},
                                         Models{ContactModel::kMdr, BodyModel::kCompliance},
                                         Models{ContactModel::kPatch, BodyModel::kNone},
                                         Models{ContactModel::kPatch, BodyModel::kSkeleton},
                                         Models{ContactModel::kPatch, BodyModel::kCompliance},
                                         Models{ContactModel::kWinkler, BodyModel::kNone}),
                         name_of_models);

TEST(MovingBodyTest, ABodyThatTurnsUnderAToolThatStaysTurnsItLikeAToolThatTurns) {
  // The body turns by 10 degrees under a ball that stands still in it, or the ball by -10 over a
  // body that rests.
  const PrepareOptions options = options_of({ContactModel::kMdr, BodyModel::kNone});
  const SceneDescription still = test::ball_on_cube();
  SceneDescription turning = still;
  const Pose& rest = still.bodies[0].pose;
  const glm::dquat turned = glm::angleAxis(glm::radians(10.0), kVertical);
  turning.bodies[0].script =
      carriage(rest, {0.0, 0.2, 0.5},
               {rest, rest, {turned * rest.position, turned * rest.rotation}})
          .script;
  Hand tool_turns(still, options);
  Hand body_turns(turning, options);
  for (int step = 0; step < 600; ++step) {
    const double time = step / kRate;
    Pose pose = tool_at(std::min(time, 0.2));
    body_turns.step_to({pose});
    const double share = std::max(0.0, std::min((time - 0.2) / 0.3, 1.0));
    pose.rotation = glm::angleAxis(-glm::radians(10.0) * share, kVertical);
    tool_turns.step_to({pose});
    ASSERT_NEAR(body_turns.wrench().force.y, tool_turns.wrench().force.y,
                1e-9 + kRounding * std::abs(tool_turns.wrench().force.y));
    ASSERT_NEAR(body_turns.wrench().torque.y, tool_turns.wrench().torque.y, 1e-8) << time;
  }
  EXPECT_GT(std::abs(tool_turns.wrench().torque.y), 1e-3);
}

TEST(MovingBodyTest, ABodyThatJumpsIsAFaultLikeAToolThatDoes) {
  SceneDescription scene = test::ball_on_cube();
  const Pose rest = scene.bodies[0].pose;
  Pose far = rest;
  far.position.x += 1.0;
  Carriage jumps = carriage(rest, {0.0, 0.05, 1.0}, {rest, far, far});
  jumps.script.links[0].animated_translation.interpolation = Interpolation::kStep;
  scene.bodies[0].script = jumps.script;
  Hand hand(scene, options_of({ContactModel::kMdr, BodyModel::kNone}));
  std::uint32_t faults = 0;
  for (int step = 0; step < 100; ++step) {
    hand.step_to({tool_at(0.1)});
    faults |= hand.clock().faults;
  }
  EXPECT_NE(faults & static_cast<std::uint32_t>(Fault::kPoseJumped), 0U);
  EXPECT_EQ(hand.wrench().force, glm::dvec3(0.0));  // the body has gone
}

}  // namespace
}  // namespace torsion::engine
