#include <gtest/gtest.h>

#include "app/live/recording_file.hpp"
#include "tests/app/live_session.hpp"
#include "tests/app/program.hpp"
#include "tests/app/small_disk.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

using test::Folder;
using test::read_text;
using test::write_text;

/// Some steps of the ball, with a change of the material before step 3.
Recording some_recording() {
  const Session session = test::ball_session();
  Recording recording = begin_recording(session, test::ball_options());
  for (std::uint64_t step = 0; step < 6; ++step) {
    if (step == 3) {
      BodyPick pick = recording.picks[0];
      pick.elasticity.youngs_modulus = 1.25e5;
      recording.entries.push_back(body_entry(step, 0, pick));
      recording.entries.push_back({InputKind::kRebuild, 0, step, {}});
    }
    const Pose pose{{0.0, 0.15 - 1e-4 * static_cast<double>(step), 1.0 / 3.0},
                    glm::normalize(glm::dquat(0.9, 0.1, 0.2, 0.3))};
    recording.entries.push_back(pose_entry(step, 0, pose, Pose{}));
  }
  return recording;
}

std::string saved(const Folder& folder) {
  const std::string path = folder / "a.rec";
  EXPECT_TRUE(save_recording(some_recording(), path).ok());
  return path;
}

std::string error_of(const Folder& folder, const std::string& bytes) {
  const std::string path = folder / "b.rec";
  write_text(path, bytes);
  const Result<Recording> loaded = load_recording(path);
  return loaded ? "" : loaded.error().text;
}

TEST(RecordingTest, ComesBackFromAFileBitForBit) {
  const Folder folder;
  const Recording written = some_recording();
  const Result<Recording> read = load_recording(saved(folder));
  ASSERT_TRUE(read) << read.error().text;
  const Recording& recording = read.value();
  EXPECT_EQ(recording.scene, written.scene);
  EXPECT_EQ(recording.rate, written.rate);
  EXPECT_EQ(recording.tools, written.tools);
  EXPECT_EQ(recording.world_hash, written.world_hash);
  EXPECT_EQ(recording.picks[0].contact, ContactModel::kMdr);
  EXPECT_EQ(recording.scene_picks[0].contact, ContactModel::kAuto);
  ASSERT_EQ(recording.entries.size(), written.entries.size());
  EXPECT_EQ(steps_in(recording), 6U);
  for (std::size_t i = 0; i < written.entries.size(); ++i) {
    EXPECT_EQ(recording.entries[i].kind, written.entries[i].kind);
    EXPECT_EQ(recording.entries[i].values, written.entries[i].values);
  }
}

TEST(RecordingTest, WhatWasChosenAfterTheLastStepEndsNoReplay) {
  // Leaving the window right after switching a model recorded the switch without a step.
  Recording recording = some_recording();
  BodyPick pick = recording.picks[0];
  pick.contact = ContactModel::kPatch;
  recording.entries.push_back(body_entry(6, 0, pick));
  recording.entries.push_back({InputKind::kRebuild, 0, 6, {}});
  EXPECT_EQ(steps_in(recording), 6U);
  recording.entries.erase(recording.entries.begin(), recording.entries.end() - 2);
  EXPECT_EQ(steps_in(recording), 0U);
}

TEST(RecordingTest, MaterialsAndSettingsThatNoSessionCanHaveAreRefused) {
  const Folder folder;
  const std::string path = folder / "a.rec";
  const auto refused = [&path](const Recording& recording) {
    EXPECT_TRUE(save_recording(recording, path).ok());
    const Result<Recording> loaded = load_recording(path);
    return !loaded && loaded.error().text.find("damaged") != std::string::npos;
  };
  Recording recording = some_recording();
  recording.picks[0].elasticity.poisson_ratio = 0.9;
  EXPECT_TRUE(refused(recording));
  recording = some_recording();
  recording.scene_picks[0].elasticity.youngs_modulus = -1.0;
  EXPECT_TRUE(refused(recording));
  for (const Settings settings : {Settings{65, 2}, Settings{16, 0}, Settings{16, 101}}) {
    recording = some_recording();
    recording.settings = settings;
    EXPECT_TRUE(refused(recording)) << settings.grid_side << " " << settings.iterations;
  }
}

TEST(RecordingTest, EveryDamagedByteIsFound) {
  const Folder folder;
  const std::string whole = read_text(saved(folder));
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    EXPECT_NE(error_of(folder, damaged), "") << "byte " << at;
  }
  for (std::size_t size = 0; size < whole.size(); size += 61) {
    EXPECT_NE(error_of(folder, whole.substr(0, size)), "") << "cut to " << size;
  }
  EXPECT_NE(error_of(folder, whole + "x"), "");
}

TEST(RecordingTest, SaysWhatIsWrong) {
  const Folder folder;
  EXPECT_NE(error_of(folder, "glTF").find("not a recording"), std::string::npos);
  std::string newer = read_text(saved(folder));
  newer[12] = 9;  // the version
  EXPECT_NE(error_of(folder, newer).find("version 9"), std::string::npos);
  EXPECT_NE(load_recording(folder / "none.rec").error().text.find("cannot be read"),
            std::string::npos);
}

#ifdef TORSION_SANITIZED
constexpr std::uint64_t kManySteps = 60'000;  // each costs twenty times as much
#else
constexpr std::uint64_t kManySteps = 600'000;
#endif

TEST(RecordingTest, TenMinutesAreWrittenInTheSameMemoryAndComeBack) {
  const Folder folder;
  const std::string path = folder / "long.rec";
  const Session session = test::ball_session();
  Result<RecordingWriter> made =
      RecordingWriter::create(path, begin_recording(session, test::ball_options()));
  ASSERT_TRUE(made) << made.error().text;
  RecordingWriter writer = std::move(made).value();
  const auto pose_at = [](std::uint64_t step) {
    return Pose{{0.0, 1e-9 * static_cast<double>(step), 0.0}, {1.0, 0.0, 0.0, 0.0}};
  };
  writer.add(pose_entry(0, 0, pose_at(0), Pose{}));
  {
    const test::AllocationGuard guard;
    for (std::uint64_t step = 1; step < kManySteps; ++step) {
      writer.add(pose_entry(step, 0, pose_at(step), Pose{}));
    }
    EXPECT_LE(guard.allocations(), 1U);  // the file's own buffer
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(writer.finish());
  const Result<Recording> read = load_recording(path);
  ASSERT_TRUE(read) << read.error().text;
  ASSERT_EQ(steps_in(read.value()), kManySteps);
  for (std::uint64_t step = 0; step < kManySteps; step += 997) {
    EXPECT_EQ(pose_of(read.value().entries[step]).position, pose_at(step).position);
  }
}

TEST(RecordingTest, AFullDiskIsSaidAndLeavesNothingBehind) {
  const Folder folder;
  const Session session = test::ball_session();
  Result<RecordingWriter> made =
      RecordingWriter::create(folder / "full.rec", begin_recording(session, test::ball_options()));
  ASSERT_TRUE(made) << made.error().text;
  {
    const test::SmallDisk small(65536);
    for (std::uint64_t step = 0; step < 10'000; ++step) {
      made.value().add(pose_entry(step, 0, Pose{}, Pose{}));
    }
  }
  const std::string problem = made.value().problem();
  EXPECT_NE(problem.find("full.rec: cannot be written: "), std::string::npos) << problem;
  EXPECT_NE(problem.find("choose another place or free it"), std::string::npos) << problem;
  const Result<Done> done = made.value().finish();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().text, problem);
  EXPECT_TRUE(folder.empty());
}

TEST(RecordingTest, EntriesOutOfOrderAreRefused) {
  const Folder folder;
  Recording recording = some_recording();
  std::swap(recording.entries.front(), recording.entries.back());
  ASSERT_TRUE(save_recording(recording, folder / "c.rec").ok());
  EXPECT_NE(load_recording(folder / "c.rec").error().text.find("not in order"), std::string::npos);
}

TEST(RecordingTest, ReplayTakesTheMaterialFromItsStepOn) {
  const Recording recording = some_recording();
  Session session = test::ball_session();
  Replay replay{&recording, 0};
  for (int i = 0; i < 6; ++i) {
    const double before = session.simulation.world.model.bodies.at<Elasticity>(0).youngs_modulus;
    EXPECT_EQ(before == 1.25e5, i > 3);
    ASSERT_TRUE(replay_inputs(replay, session, true));
    EXPECT_EQ(session.tool_poses[0].position.y, 0.15 - 1e-4 * i);
    step(session.simulation, session.tool_poses);
  }
  EXPECT_EQ(session.simulation.world.state.clock.step, 6U);
}

}  // namespace
}  // namespace torsion::engine
