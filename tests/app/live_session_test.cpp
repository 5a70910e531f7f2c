// A session as a window drives it, without one: switching models, restarting, recording.

#include "app/live/live_session.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "ecs/hash.hpp"
#include "tests/app/live_session.hpp"
#include "tests/support/waiting.hpp"

namespace torsion {
namespace {

/// Refreshes until it holds.
template <class F>
bool comes_true(LiveSession& session, F&& holds) {
  return test::comes_true([&] {
    session.refresh();
    return holds();
  });
}

const Clock& clock_of(const LiveSession& session) {
  return session.frame().snapshot.clock.at<Clock>(0);
}

TEST(LiveSessionTest, SwitchesModelsWhileHeldAndItsRecordingGivesTheSameBits) {
  constexpr bool kPrivileges = false;
  LiveSession session(test::ball_session(), test::ball_options());
  session.start(kPrivileges);
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 10; }));
  session.hold(0, {{0.0, test::kTouching - 1e-3, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)});
  ASSERT_TRUE(comes_true(session, [&] { return !session.frame().snapshot.regions.empty(); }));

  std::vector<BodyPick> picks = session.shown().picks;
  picks[0].contact = ContactModel::kPaper;
  picks[0].elasticity.youngs_modulus = 1e6;
  ASSERT_TRUE(session.choose(picks, false));
  EXPECT_FALSE(session.choose(picks, false));  // one at a time
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().generation == 1; }));
  EXPECT_EQ(session.shown().picks[0].contact, ContactModel::kPaper);
  EXPECT_EQ(session.preparation_error(), "");
  const std::uint64_t switched = clock_of(session).step;
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > switched + 100; }));
  session.pause(true);
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().paused; }));
  session.refresh();

  Session again = test::ball_session();
  Replay replay{&session.recording(), 0};
  const std::uint64_t steps = steps_in(session.recording());
  ASSERT_EQ(steps, clock_of(session).step);
  for (std::uint64_t i = 0; i < steps; ++i) {
    ASSERT_TRUE(replay_inputs(replay, again, true));
    step(again.simulation, again.tool_poses);
  }
  // The live one stands still: paused, and no command is under way.
  EXPECT_EQ(hash(again.simulation.world), hash(session.shown().simulation.world));
}

TEST(LiveSessionTest, ARestartBeginsAnewAndSoDoesItsRecording) {
  constexpr bool kPrivileges = false;
  LiveSession session(test::ball_session(), test::ball_options());
  session.start(kPrivileges);
  session.hold(0, {{0.0, test::kTouching, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)});
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 300; }));
  const std::uint64_t before = steps_in(session.recording());
  ASSERT_TRUE(session.choose(session.shown().picks, true));
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().generation == 1; }));
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 20; }));
  EXPECT_FALSE(session.held(0));
  EXPECT_GE(before, 300U);
  EXPECT_EQ(session.recording().entries.front().step, 0U);
}

TEST(LiveSessionTest, ADeviceHasTheToolFromTheStartOnAndAfterARestart) {
  constexpr bool kPrivileges = false;
  LiveSession session(test::ball_session(), test::ball_options());
  session.give({std::make_unique<DeviceLink>(Pose{}), 0});
  session.start(kPrivileges);
  EXPECT_TRUE(session.on_device(0));
  // Nothing is plugged in, so the tool stays; its animation would have moved it.
  const auto place = [&] {
    return session.frame().snapshot.tools.at<ToolPose>(0).now.position;
  };
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 5; }));
  const glm::dvec3 first = place();
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 400; }));
  EXPECT_EQ(place(), first);
  ASSERT_TRUE(session.choose(session.shown().picks, true));
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().generation == 1; }));
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 400; }));
  EXPECT_EQ(place(), first);
  EXPECT_EQ(session.device()->sample.state, DeviceState::kAbsent);
}

TEST(LiveSessionTest, AMouseHoldsNoDeeperThanTheModelsGo) {
  const Session session = test::ball_session();
  const VirtualCoupling coupling = mouse_coupling(session.scene, 0.05);
  // Hertz: the depth at which the half-space pushes back with the coupling's largest force.
  const double modulus = session.scene.bodies[0].elasticity.contact_modulus();
  const double depth =
      std::pow(coupling.largest_force / (4.0 / 3.0 * modulus * std::sqrt(0.05)), 2.0 / 3.0);
  // Deep enough for the shipped scenes' presses, short of half the tool, which is a fault.
  EXPECT_LT(depth, 0.3 * 0.05);
  EXPECT_GT(depth, 0.2 * 0.05);
}

}  // namespace
}  // namespace torsion
