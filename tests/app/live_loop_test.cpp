// The loop of a live session, ticked by hand and by its thread.

#include "app/live/live_loop.hpp"

#include <chrono>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sched.h>

#include "app/live/rebuild.hpp"
#include "app/live/thread_starter.hpp"
#include "ecs/hash.hpp"
#include "tests/app/live_session.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

using test::AllocationGuard;
using test::ball_session;
using test::kTouching;
using test::LiveThread;

VirtualCoupling coupling() {
  return {500.0, 0.0, 0.5, 0.0, 5.0, 0.2};
}

/// Asks for the tool at `y`, turned by `turn` about the vertical.
void hold_at(HandleSlot& slot, std::uint64_t number, double y, double turn = 0.0) {
  HandleSample& sample = slot.sample.back();
  sample.pose = {{0.0, y, 0.0}, glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0))};
  sample.number = number;
  slot.sample.publish();
}

TEST(StepScheduleTest, LatenessDoesNotAddUp) {
  StepSchedule schedule{1000, 5000, 0};
  EXPECT_EQ(begin_step(schedule, 5300), 300);
  EXPECT_EQ(schedule.due, 6000);
  EXPECT_EQ(begin_step(schedule, 6000), 0);
  EXPECT_EQ(schedule.due, 7000);
  EXPECT_EQ(schedule.skipped, 0U);
}

TEST(StepScheduleTest, MakesUpForFourPeriodsAndSkipsTheRest) {
  StepSchedule schedule{1000, 0, 0};
  EXPECT_EQ(begin_step(schedule, 10'500), 10'500);
  EXPECT_EQ(schedule.skipped, 6U);
  // Of the ten periods missed four are still to be made up for, at once: they are due before now.
  int made_up = 0;
  while (schedule.due <= 10'500) {
    begin_step(schedule, 10'500);
    ++made_up;
  }
  EXPECT_EQ(made_up, 4);
  EXPECT_EQ(schedule.skipped, 6U);
}

TEST(StepScheduleTest, FollowsADevicesClockWithoutHurry) {
  // A device 0.03 % slow or fast, in any phase to the steps at first; samples arrive up to 50 us
  // late, as behind a frame of USB.
  constexpr Nanoseconds kPeriod = 1'000'000;
  std::minstd_rand random(1);
  for (const Nanoseconds device : {kPeriod - 300, kPeriod + 300}) {
    for (const Nanoseconds phase : {0, 90'000, 400'000, 700'000, 999'000}) {
      StepSchedule schedule{kPeriod, 10 * kPeriod, 0};
      Nanoseconds number = 0;
      for (int step = 0; step < 2000; ++step) {
        const Nanoseconds begun = schedule.due;
        begin_step(schedule, begun);
        number = (begun - phase) / device;  // of the newest sample
        const Nanoseconds arrived =
            phase + number * device + static_cast<Nanoseconds>(random() % 50'000);
        if (arrived <= begun) {
          follow_samples(schedule, arrived);
        }
        // No step is longer or shorter than the scheduler's own jitter makes it.
        EXPECT_NEAR(static_cast<double>(schedule.due - begun), kPeriod, kPeriod / 200);
        if (step > 500) {
          // A tenth of a period after the sample, but for its jitter: far from the next one.
          EXPECT_NEAR(static_cast<double>(begun - (phase + number * device)), 0.1 * kPeriod, 60e3);
        }
      }
    }
  }
}

/// The scheduling that a new thread of the calling thread has.
int policy_of_new_thread() {
  int policy = -1;
  std::thread([&policy] { policy = ::sched_getscheduler(0); }).join();
  return policy;
}

TEST(ThreadStarterTest, ThreadsItStartsDoNotMakeWayWithTheOneThatDraws) {
  std::thread draws([] {
    ThreadStarter starter;
    make_way_for_realtime();
    EXPECT_EQ(policy_of_new_thread(), SCHED_IDLE);
    int policy = -1;
    starter.run([&policy] { policy = policy_of_new_thread(); });
    EXPECT_EQ(policy, SCHED_OTHER);
  });
  draws.join();
}

/// From the start on.
void hold(LiveTool& tool, HandleSlot& slot) {
  tool.from = PoseFrom::kHandle;
  tool.slot = &slot;
  tool.coupling = coupling();
}

TEST(LiveLoopTest, ATickTakesNothingFromTheHeap) {
  Session session = ball_session();
  HandleSlot slot;
  LiveLoop loop;
  loop.wants_rows = true;
  loop.wants_inputs = true;
  loop.wants_pictures = true;
  reserve(loop, session, session.simulation);
  hold(loop.tools[0], slot);
  for (int i = 0; i < 200; ++i) {
    hold_at(slot, static_cast<std::uint64_t>(i) + 1, kTouching - 1e-5 * i, 1e-3 * i);
    const AllocationGuard guard;
    live_tick(loop, 0.0);
    loop.frames.refresh();
    EXPECT_EQ(guard.allocations(), 0U);
    EXPECT_EQ(guard.releases(), 0U);
  }
  EXPECT_GT(session.simulation.world.state.tools.at<ToolWrench>(0).total.force.y, 0.0);
}

TEST(LiveLoopTest, TheHandleFeelsWhatTheToolDoes) {
  Session session = ball_session();
  HandleSlot slot;
  LiveLoop loop;
  reserve(loop, session, session.simulation);
  loop.tools[0].from = PoseFrom::kHandle;
  loop.tools[0].slot = &slot;
  loop.tools[0].coupling = coupling();
  for (std::uint64_t i = 1; i <= 500; ++i) {
    hold_at(slot, i, kTouching - 2e-3);
    live_tick(loop, 0.0);
  }
  ASSERT_TRUE(slot.answer.refresh());
  const HandleAnswer& answer = slot.answer.front();
  const Wrench& contact = session.simulation.world.state.tools.at<ToolWrench>(0).total;
  EXPECT_EQ(answer.sample, 500U);
  EXPECT_EQ(answer.faults, 0U);
  // A tool without mass passes on what it is pushed with: to 1e-6 once it is at rest.
  EXPECT_GT(contact.force.y, 0.1);
  EXPECT_NEAR(answer.wrench.force.y, contact.force.y, 1e-6 * contact.force.y);
}

TEST(LiveLoopTest, PauseHoldsTheTimeAndASingleStepMovesItByOne) {
  Session session = ball_session();
  LiveLoop loop;
  reserve(loop, session, session.simulation);
  const Clock& clock = session.simulation.world.state.clock;
  live_tick(loop, 0.0);
  EXPECT_EQ(clock.step, 1U);
  loop.commands.push({LiveCommandKind::kPause, 0, 1, nullptr});
  live_tick(loop, 0.0);
  live_tick(loop, 0.0);
  EXPECT_EQ(clock.step, 1U);
  loop.commands.push({LiveCommandKind::kStepOnce, 0, 0, nullptr});
  live_tick(loop, 0.0);
  live_tick(loop, 0.0);
  EXPECT_EQ(clock.step, 2U);
  loop.commands.push({LiveCommandKind::kPause, 0, 0, nullptr});
  loop.commands.push({LiveCommandKind::kSlowness, 0, 5, nullptr});
  for (int i = 0; i < 50; ++i) {
    live_tick(loop, 0.0);
  }
  EXPECT_EQ(clock.step, 12U);
}

TEST(LiveLoopTest, ASwitchOfModelsGoesOnWhereTheToolIs) {
  Session session = ball_session();
  HandleSlot slot;
  LiveLoop loop;
  loop.wants_inputs = true;
  reserve(loop, session, session.simulation);
  loop.tools[0].from = PoseFrom::kHandle;
  loop.tools[0].slot = &slot;
  loop.tools[0].coupling = coupling();
  for (std::uint64_t i = 1; i <= 300; ++i) {
    hold_at(slot, i, kTouching - 2e-3);
    live_tick(loop, 0.0);
  }
  const Pose before = session.simulation.world.state.tools.at<ToolPose>(0).now;
  Generation next;
  next.number = 1;
  next.picks = picks_of(session.scene, test::ball_options());
  next.picks[0].contact = ContactModel::kPatch;
  SceneDescription scene = session.scene;
  apply_picks(next.picks, scene);
  next.simulation = prepare(scene, {}).value();
  loop.commands.push({LiveCommandKind::kSwap, 0, 0, &next});
  live_tick(loop, 0.0);
  const World& world = next.simulation.world;
  EXPECT_EQ(world.state.clock.step, 301U);
  EXPECT_EQ(world.state.clock.faults, 0U);
  // While the contact is not yet known the tool waits; then patch lets it sink as mdr did, to their
  // 2 % of each other in stiffness, and the coupling moves by less.
  double farthest = 0.0;
  for (int i = 0; i < 300; ++i) {
    live_tick(loop, 0.0);
    farthest = std::max(
        farthest, glm::length(world.state.tools.at<ToolPose>(0).now.position - before.position));
  }
  EXPECT_LT(farthest, 0.05 * (kTouching - before.position.y));
  EXPECT_EQ(world.state.clock.faults_ever, 0U);
  EXPECT_GT(world.state.tools.at<ToolWrench>(0).total.force.y, 0.1);
}

/// The step of the frame that is taken after so many ticks of which none was.
std::uint64_t step_of_next_frame(LiveLoop& loop, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) {
    live_tick(loop, 0.0);
  }
  loop.frames.refresh();
  return loop.frames.front().snapshot.clock.step;
}

TEST(LiveLoopTest, AFrameIsMadeOnceTheLastWasTakenAndEvery8MillisecondsBesides) {
  Session session = ball_session();
  LiveLoop loop;
  loop.wants_pictures = true;
  reserve(loop, session, session.simulation);
  EXPECT_EQ(step_of_next_frame(loop, 1), 1U);
  EXPECT_EQ(step_of_next_frame(loop, 1), 2U);
  EXPECT_EQ(step_of_next_frame(loop, 6), 3U);   // not in each of the ticks after it
  EXPECT_EQ(step_of_next_frame(loop, 9), 17U);  // of step 9 is the first, 8 ms later another
}

TEST(LiveLoopTest, WhatOnlyAPictureNeedsIsFoundForWhoDraws) {
  for (const bool draws : {false, true}) {
    Session session = ball_session();
    HandleSlot slot;
    LiveLoop loop;
    loop.wants_pictures = draws;
    reserve(loop, session, session.simulation);
    hold(loop.tools[0], slot);
    for (int i = 0; i < 200; ++i) {
      hold_at(slot, static_cast<std::uint64_t>(i) + 1, kTouching - 1e-5 * i, 1e-3 * i);
      live_tick(loop, 0.0);
    }
    loop.frames.refresh();
    live_tick(loop, 0.0);
    loop.frames.refresh();
    const Snapshot& snapshot = loop.frames.front().snapshot;
    ASSERT_EQ(snapshot.regions.size(), 1U);
    ASSERT_EQ(snapshot.region_fields.size(), 1U);
    EXPECT_EQ(snapshot.region_fields.at<RegionField>(0).radius > 0.0, draws);
  }
}

TEST(LiveLoopTest, ThreeThreadsShareNothingButBoxesAndTheRecordingGivesTheSameBits) {
  Session session = ball_session();
  Recording recording = begin_recording(session, test::ball_options());
  HandleSlot slot;
  LiveLoop loop;
  loop.wants_privileges = false;
  loop.wants_inputs = true;
  loop.wants_rows = true;
  reserve(loop, session, session.simulation);
  loop.steps_left = 400;
  loop.tools[0].from = PoseFrom::kHandle;
  loop.tools[0].slot = &slot;
  loop.tools[0].coupling = coupling();
  std::atomic<bool> done = false;
  std::thread device([&] {
    for (std::uint64_t i = 1; !done; ++i) {
      hold_at(slot, i, kTouching - 2e-3, 1e-3 * static_cast<double>(i % 500));
      slot.answer.refresh();
      std::this_thread::sleep_for(std::chrono::microseconds(700));
    }
  });
  std::uint64_t rows = 0;
  {
    const LiveThread physics(loop);
    std::uint64_t last = 0;
    while (!loop.over) {
      if (loop.frames.refresh()) {
        const LiveFrame& frame = loop.frames.front();
        const Clock& clock = frame.snapshot.clock;
        EXPECT_GE(clock.step, last);
        EXPECT_EQ(frame.statistics.steps, clock.step);  // a frame is whole
        last = clock.step;
      }
      while (const auto entry = loop.inputs.pop()) {
        recording.entries.push_back(*entry);
      }
      while (loop.rows.pop()) {
        ++rows;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
  }
  done = true;
  device.join();
  while (const auto entry = loop.inputs.pop()) {
    recording.entries.push_back(*entry);
  }
  while (loop.rows.pop()) {
    ++rows;
  }
  EXPECT_EQ(rows, 400U);
  EXPECT_EQ(steps_in(recording), 400U);

  Session again = ball_session();
  Replay replay{&recording, 0};
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(replay_inputs(replay, again, true));
    step(again.simulation, again.tool_poses);
  }
  EXPECT_EQ(hash(again.simulation.world), hash(session.simulation.world));
  EXPECT_GT(again.simulation.world.state.tools.at<ToolWrench>(0).total.force.y, 0.0);
}

}  // namespace
}  // namespace torsion::engine
