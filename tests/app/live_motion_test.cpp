// What moves in a live loop: a tool that a hand takes and lets go of while its animation goes on,
// and a body with an animation of its own.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/live/live_loop.hpp"
#include "app/live/rebuild.hpp"
#include "systems/hold/virtual_coupling.hpp"
#include "tests/app/live_session.hpp"

namespace torsion::engine {
namespace {

using test::ball_session;
using test::kTouching;

TEST(LiveMotionTest, AToolThatIsLetGoOfGoesBackToItsAnimationAndOnWithIt) {
  Session session = ball_session();
  // From over the cube down into it, within two seconds.
  MotionScript& script = session.scene.tools[0].script;
  script.links.back().animated_translation = {
      Interpolation::kLinear,
      {0.0, 2.0},
      {{0.0, kTouching + 0.01, 0.0, 0.0}, {0.0, kTouching - 2e-3, 0.0, 0.0}}};
  HandleSlot slot;
  LiveLoop loop;
  reserve(loop, session, session.simulation);
  loop.tools[0].slot = &slot;
  loop.tools[0].coupling = {500.0, 0.0, 0.5, 0.0, 5.0, 0.2};
  loop.tools[0].smoothing.on = true;
  const auto& tools = session.simulation.world.state.tools;
  glm::dvec3 last(0.0);
  std::uint64_t samples = 0;
  double farthest = 0.0;  // m, in a step
  const auto tick = [&] {
    live_tick(loop, 0.0);
    const glm::dvec3& now = tools.at<ToolPose>(0).now.position;
    farthest = std::max(farthest, glm::length(now - last));
    last = now;
  };
  const auto from = [&](PoseFrom source) {
    loop.commands.push(
        {LiveCommandKind::kPoseFrom, 0, static_cast<std::uint64_t>(source), nullptr});
  };
  tick();
  farthest = 0.0;
  for (int round = 0; round < 2; ++round) {
    // Taken where it is, moved 30 mm aside at 0.1 m/s, and let go of.
    Pose handle = tools.at<ToolPose>(0).now;
    const auto say = [&] {
      slot.sample.back().pose = handle;
      slot.sample.back().number = ++samples;
      slot.sample.publish();
    };
    say();  // as LiveSession::hold() does, before the command
    from(PoseFrom::kHandle);
    for (int i = 0; i < 300; ++i) {
      tick();
      handle.position.x += 1e-4;
      say();
    }
    EXPECT_GT(last.x, 0.02);
    tick();  // takes the last sample
    from(PoseFrom::kScript);
    for (int i = 0; i < 1100; ++i) {
      tick();
    }
    const double time = session.simulation.world.state.clock.time;
    EXPECT_NEAR(last.x, 0.0, 1e-12) << time;
    const double scripted = kTouching + 0.01 - 0.012 * std::min(time / 2.0, 1.0);
    EXPECT_NEAR(last.y, scripted, 1e-9) << time;
    // The hand's 0.1 m/s, or 1.5 times 30 mm/s of the way back: no jump anywhere.
    EXPECT_LT(farthest, 1.3e-4) << time;
  }
}

TEST(LiveMotionTest, AToolThatIsTakenWhileItPressesStaysWhereItIs) {
  Session session = ball_session();
  // Down by 2 mm within a second, turned by 5 degrees in the next.
  MotionLink& link = session.scene.tools[0].script.links.back();
  link.animated_translation = {
      Interpolation::kLinear,
      {0.0, 1.0},
      {{0.0, kTouching + 1e-3, 0.0, 0.0}, {0.0, kTouching - 2e-3, 0.0, 0.0}}};
  const glm::dquat turned = glm::angleAxis(glm::radians(5.0), glm::dvec3(0.0, 1.0, 0.0));
  link.animated_rotation = {Interpolation::kLinear,
                            {1.0, 2.0},
                            {{0.0, 0.0, 0.0, 1.0}, {turned.x, turned.y, turned.z, turned.w}}};
  HandleSlot slot;
  LiveLoop loop;
  reserve(loop, session, session.simulation);
  const World& world = session.simulation.world;
  loop.tools[0].slot = &slot;
  loop.tools[0].smoothing.on = true;
  for (int i = 0; i < 2100; ++i) {
    live_tick(loop, 0.0);
  }
  const Pose before = world.state.tools.at<ToolPose>(0).now;
  const Wrench held = world.state.tools.at<ToolWrench>(0).total;
  const double force = glm::length(held.force);
  const double torque = glm::length(held.torque);
  ASSERT_GT(torque, 0.1 * force * 2e-3);
  loop.tools[0].coupling = {1e3, 0.0, 5.0, 0.0, 2.0 * force, 2.0 * torque};
  HandleSample& sample = slot.sample.back();
  sample.pose =
      balancing_handle(loop.tools[0].coupling, before, wrench_about_frame(world.state, 0));
  sample.number = 1;
  slot.sample.publish();
  loop.commands.push(
      {LiveCommandKind::kPoseFrom, 0, static_cast<std::uint64_t>(PoseFrom::kHandle), nullptr});
  for (int i = 0; i < 300; ++i) {
    live_tick(loop, 0.0);
    const Wrench& now = world.state.tools.at<ToolWrench>(0).total;
    ASSERT_NEAR(now.force.y, held.force.y, 1e-3 * force) << i;
    ASSERT_NEAR(now.torque.y, held.torque.y, 1e-2 * torque) << i;
  }
}

TEST(LiveMotionTest, ASwitchOfModelsGoesOnWhereAMovingBodyIs) {
  Session session = ball_session();
  // The cube comes up to the ball by 3 mm within half a second, and 0.2 m aside with it.
  const Pose rest = session.scene.bodies[0].pose;
  MotionLink link;
  link.animated_translation = {
      Interpolation::kLinear,
      {0.0, 0.5},
      {{rest.position, 0.0}, {rest.position + glm::dvec3(0.2, 3e-3, 0.0), 0.0}}};
  session.scene.bodies[0].script = {{link}, 0.5};
  MotionLink& tool = session.scene.tools[0].script.links.back();
  tool.animated_translation = {
      Interpolation::kLinear,
      {0.0, 0.5},
      {{0.0, kTouching + 1e-3, 0.0, 0.0}, {0.2, kTouching + 1e-3, 0.0, 0.0}}};
  session.simulation = prepare(session.scene, test::ball_options()).value();
  LiveLoop loop;
  reserve(loop, session, session.simulation);
  for (int i = 0; i < 480; ++i) {
    live_tick(loop, 0.0);
  }
  const double force = session.simulation.world.state.tools.at<ToolWrench>(0).total.force.y;
  EXPECT_GT(force, 0.1);
  Generation next;
  next.number = 1;
  next.picks = picks_of(session.scene, test::ball_options());
  next.simulation = prepare(session.scene, test::ball_options()).value();
  loop.commands.push({LiveCommandKind::kSwap, 0, 0, &next});
  for (int i = 0; i < 200; ++i) {
    live_tick(loop, 0.0);
  }
  const State& state = next.simulation.world.state;
  EXPECT_EQ(state.clock.faults_ever, 0U);
  EXPECT_NEAR(state.bodies.at<BodyPose>(0).now.position.x, rest.position.x + 0.2, 1e-12);
  EXPECT_GT(state.tools.at<ToolWrench>(0).total.force.y, force);
}

}  // namespace
}  // namespace torsion::engine
