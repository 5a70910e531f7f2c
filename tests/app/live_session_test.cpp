// A session as a window drives it, without one: switching models, restarting, recording.

#include "app/live/live_session.hpp"

#include <algorithm>
#include <span>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/live/periodic_clock.hpp"
#include "ecs/hash.hpp"
#include "tests/app/live_session.hpp"
#include "tests/app/program.hpp"
#include "tests/app/small_disk.hpp"
#include "tests/support/waiting.hpp"

namespace torsion::engine {
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
  return session.frame().snapshot.clock;
}

/// What it has recorded since its start.
Recording recorded(LiveSession& session) {
  const test::Folder folder;
  EXPECT_TRUE(session.save_recording(folder / "a.rec"));
  Result<Recording> loaded = load_recording(folder / "a.rec");
  EXPECT_TRUE(loaded) << loaded.error().text;
  return loaded ? std::move(loaded).value() : Recording{};
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
  const Recording recording = recorded(session);
  Replay replay{&recording, 0};
  const std::uint64_t steps = steps_in(recording);
  ASSERT_EQ(steps, clock_of(session).step);
  for (std::uint64_t i = 0; i < steps; ++i) {
    ASSERT_TRUE(replay_inputs(replay, again, true));
    step(again.simulation, again.tool_poses);
  }
  // The live one stands still: paused, and no command is under way.
  EXPECT_EQ(hash(again.simulation.world), hash(session.shown().simulation.world));
}

// An animation may press harder than the mouse can: who takes the tool then has the strength for
// it.
TEST(LiveSessionTest, AToolThatPressesHarderThanTheMouseStaysWhereItIsTaken) {
  constexpr bool kPrivileges = false;
  Session pressing = test::ball_session();
  pressing.scene.tools[0].script.links.back().animated_translation = {
      Interpolation::kLinear,
      {0.0, 0.2},
      {{0.0, test::kTouching, 0.0, 0.0}, {0.0, test::kTouching - 0.015, 0.0, 0.0}}};
  LiveSession session(std::move(pressing), test::ball_options());
  session.start(kPrivileges);
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).time > 0.5; }));
  const auto force = [&] {
    return session.frame().snapshot.tools.at<ToolWrench>(0).total.force.y;
  };
  const double pressed = force();
  ASSERT_GT(pressed, 1.5 * session.coupling(0).largest_force);
  session.hold(0, session.take(0));
  const std::uint64_t taken = clock_of(session).step;
  ASSERT_TRUE(comes_true(session, [&] {
    EXPECT_NEAR(force(), pressed, 1e-3 * pressed) << clock_of(session).step - taken;
    return clock_of(session).step > taken + 300 || testing::Test::HasFailure();
  }));
  EXPECT_TRUE(session.held(0));
  session.release(0);
}

// The frames' memory is taken for the first models: it has room for what any others leave.
TEST(LiveSessionTest, DrawsTheAnchorsOfABodyModelThatItIsSwitchedTo) {
  constexpr bool kPrivileges = false;
  LiveSession session(test::ball_session(), test::ball_options());
  ASSERT_EQ(session.shown().simulation.world.model.anchors.size(), 0U);
  session.start(kPrivileges);
  session.hold(0, {{0.0, test::kTouching - 1e-3, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)});
  std::vector<BodyPick> picks = session.shown().picks;
  picks[0].body = BodyModel::kSkeleton;
  ASSERT_TRUE(session.choose(picks, false));
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().generation == 1; }));
  EXPECT_EQ(session.frame().snapshot.anchors.size(),
            session.shown().simulation.world.model.anchors.size());
  EXPECT_TRUE(comes_true(session, [&] {
    const auto anchors = session.frame().snapshot.anchors.column<AnchorMotion>();
    return std::ranges::any_of(
        anchors, [](const AnchorMotion& anchor) { return anchor.displacement != glm::dvec3(0.0); });
  }));
}

TEST(LiveSessionTest, ARestartBeginsAnewAndSoDoesItsRecording) {
  constexpr bool kPrivileges = false;
  LiveSession session(test::ball_session(), test::ball_options());
  session.start(kPrivileges);
  session.hold(0, {{0.0, test::kTouching, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)});
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 300; }));
  const double before = session.recorded_seconds();
  EXPECT_EQ(before, 1e-3 * static_cast<double>(steps_in(recorded(session))));
  ASSERT_TRUE(session.choose(session.shown().picks, true));
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().generation == 1; }));
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 20; }));
  EXPECT_FALSE(session.held(0));
  EXPECT_GE(before, 0.3);
  const Recording recording = recorded(session);  // in order from step 0 on, or it cannot be read
  EXPECT_EQ(recording.entries.front().step, 0U);
  EXPECT_GE(steps_in(recording), 20U);
}

TEST(LiveSessionTest, ARestartAfterASingleStepBeginsItsRecordingAnewToo) {
  constexpr bool kPrivileges = false;
  LiveSession session(test::ball_session(), test::ball_options());
  session.pause(true);
  session.start(kPrivileges);
  const auto one_step = [&](std::uint64_t generation) {
    session.step_once();
    return comes_true(session, [&] {
      return session.frame().generation == generation && clock_of(session).step == 1;
    });
  };
  ASSERT_TRUE(one_step(0));
  ASSERT_TRUE(session.choose(session.shown().picks, true));
  ASSERT_TRUE(comes_true(session, [&] { return session.frame().generation == 1; }));
  ASSERT_TRUE(clock_of(session).step == 1 || one_step(1));
  EXPECT_EQ(steps_in(recorded(session)), 1U);
}

TEST(LiveSessionTest, RecordsToItsFileWhileItGoesOnAndCopiesBesideIt) {
  constexpr bool kPrivileges = false;
  const test::Folder folder;
  LiveSession session(test::ball_session(), test::ball_options(), folder / "a.rec");
  session.start(kPrivileges);
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > 100; }));
  // The same place, too: what is under way there is not touched.
  ASSERT_TRUE(session.save_recording(folder / "a.rec"));
  const Result<Recording> copy = load_recording(folder / "a.rec");
  ASSERT_TRUE(copy) << copy.error().text;
  const std::uint64_t copied = steps_in(copy.value());
  ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > copied + 100; }));
  ASSERT_TRUE(session.finish_recording());
  const Result<Recording> whole = load_recording(folder / "a.rec");
  ASSERT_TRUE(whole) << whole.error().text;
  EXPECT_GE(copied, 100U);
  EXPECT_GE(steps_in(whole.value()), copied + 100);
  EXPECT_TRUE(std::ranges::equal(
      copy.value().entries, std::span(whole.value().entries).first(copy.value().entries.size()),
      [](const InputEntry& a, const InputEntry& b) {
        return a.kind == b.kind && a.step == b.step && a.values == b.values;
      }));
}

TEST(LiveSessionTest, GoesOnWhenTheDiskIsFullAndSaysThatNothingIsRecorded) {
  constexpr bool kPrivileges = false;
  const test::Folder folder;
  {
    LiveSession session(test::ball_session(), test::ball_options(), folder / "full.rec");
    session.start(kPrivileges);
    const test::SmallDisk small(65536);  // half a second
    ASSERT_TRUE(comes_true(session, [&] { return !session.recording_problem().empty(); }));
    const std::uint64_t then = clock_of(session).step;
    ASSERT_TRUE(comes_true(session, [&] { return clock_of(session).step > then + 100; }));
    const std::string problem = session.recording_problem();
    EXPECT_NE(problem.find("full.rec: cannot be written: "), std::string::npos) << problem;
    EXPECT_EQ(session.save_recording(folder / "copy.rec").error().text, problem);
    EXPECT_EQ(session.finish_recording().error().text, problem);
  }
  EXPECT_TRUE(folder.empty());
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

/// A wheel that nobody turns and that says so a thousand times a second, of its own clock; the
/// tool is where the handle is.
struct StillWheel {
  DeviceLink& link;
  DeviceSample sample;

  explicit StillWheel(DeviceLink& to) : link(to) {
    sample.state = DeviceState::kLive;
    sample.epoch = 1;
    sample.plugged = 1;
    sample.sensed = kTurnAxis;
    sample.actuated = kTurnAxis;
    sample.traits.largest_torque = 0.2;
    sample.time = 1.0;
  }
  /// @return where the handle is then
  glm::dvec3 run(double seconds) {
    for (const double end = sample.time + seconds; sample.time < end; sample.time += 1e-3) {
      HandleAnswer& answer = link.slot().answer.back();
      answer.tool.position = link.view().outcome.handle.position;
      answer.time_ns = monotonic_now();
      link.slot().answer.publish();
      DeviceLink::on_sample(&link, sample);
    }
    return link.view().outcome.handle.position;
  }
};

// A knob or a wheel turns the tool; a mouse carries it, smoothly and no faster than a hand may.
TEST(DeviceLinkTest, AMouseCarriesWhatADeviceOnlyTurns) {
  DeviceLink link(Pose{});
  StillWheel wheel(link);
  wheel.run(0.1);
  MouseCarry carry;
  carry.stiffness = 1234.0;
  carry.largest_force = 20.0;
  link.carry(carry);
  const glm::dvec3 start = wheel.run(0.1);
  EXPECT_EQ(link.view().coupling.stiffness, 1234.0);
  EXPECT_EQ(link.view().coupling.largest_force, 20.0);
  carry.moved = {0.0, -0.1, 0.0};
  link.carry(carry);
  glm::dvec3 before = start;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 now = wheel.run(1e-3);
    EXPECT_LE(glm::length(now - before), 0.5e-3 + 1e-12);
    before = now;
  }
  EXPECT_NEAR(glm::length(before - start - carry.moved), 0.0, 1e-5);
}

TEST(DeviceLinkTest, AMouseDoesNotCarryWhatADeviceMoves) {
  DeviceLink link(Pose{});
  StillWheel arm(link);
  arm.sample.sensed = kTranslationAxes | kTurnAxis;
  MouseCarry carry;
  carry.stiffness = 1234.0;
  carry.moved = {0.0, -0.1, 0.0};
  link.carry(carry);
  EXPECT_EQ(arm.run(0.5), glm::dvec3(0.0));
}

TEST(LiveSessionTest, AMouseHoldsNoDeeperThanTheModelsGo) {
  const Session session = test::ball_session();
  constexpr double kStrong = 1e9;  // N
  const VirtualCoupling coupling = mouse_coupling(session.scene, 0.05, kStrong);
  // Hertz: the depth at which the half-space pushes back with the coupling's largest force.
  const double modulus = session.scene.bodies[0].elasticity.contact_modulus();
  const double depth =
      std::pow(coupling.largest_force / (4.0 / 3.0 * modulus * std::sqrt(0.05)), 2.0 / 3.0);
  // Deep enough for the shipped scenes' presses, short of half the tool, which is a fault.
  EXPECT_LT(depth, 0.3 * 0.05);
  EXPECT_GT(depth, 0.2 * 0.05);
}

TEST(LiveSessionTest, AMouseTurnsWhatItPressesWithAllItsForceWhateverTheFriction) {
  Session session = test::ball_session();
  constexpr double kRadius = 0.05;  // m
  for (const double friction : {0.05, 0.75, 1.2, 3.0}) {
    session.scene.bodies[0].friction = {friction, friction};
    for (const double modulus : {1e4, 3e6}) {
      Elasticity& elasticity = session.scene.bodies[0].elasticity;
      elasticity.youngs_modulus = modulus;
      const VirtualCoupling coupling = mouse_coupling(session.scene, kRadius, kGentleForce);
      // The torque of a sphere's contact that slips as a whole, 3 pi / 16 mu F a, with Hertz's a.
      const double force = coupling.largest_force;
      const double contact_radius =
          std::cbrt(0.75 * force * kRadius / elasticity.contact_modulus());
      const double slips = 3.0 * std::numbers::pi / 16.0 * friction * force * contact_radius;
      EXPECT_GT(coupling.largest_torque, 1.4 * slips) << friction;
      EXPECT_LT(coupling.largest_torque, 1.6 * slips) << friction;
    }
  }
}

TEST(LiveSessionTest, AMouseIsGentleOnAHardBody) {
  Session session = test::ball_session();
  for (const double modulus : {1e4, 3e6, 1e9}) {
    session.scene.bodies[0].elasticity.youngs_modulus = modulus;
    const VirtualCoupling strongest = mouse_coupling(session.scene, 0.05, 1e12);
    const VirtualCoupling gentle = mouse_coupling(session.scene, 0.05, kGentleForce);
    EXPECT_LE(gentle.largest_force, kGentleForce);
    EXPECT_LE(gentle.largest_force, strongest.largest_force);
    // The largest force is as far from the tool as with the strongest hand, on a body of any
    // modulus: a third of the tool's radius.
    EXPECT_NEAR(gentle.largest_force / gentle.stiffness, 0.34 * 0.05, 0.01 * 0.05);
    // The torque that friction can hold, mu F a, falls with the force and the contact's radius.
    const double share = gentle.largest_force / strongest.largest_force;
    EXPECT_NEAR(gentle.largest_torque, strongest.largest_torque * std::pow(share, 4.0 / 3.0),
                1e-9 * strongest.largest_torque);
  }
}

}  // namespace
}  // namespace torsion::engine
