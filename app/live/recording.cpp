#include "app/live/recording.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "device/scripted_motion.hpp"
#include "ecs/assert.hpp"
#include "ecs/hash.hpp"

namespace torsion::engine {
namespace {

bool same_pick(const BodyPick& a, const BodyPick& b) {
  return body_entry(0, 0, a).values == body_entry(0, 0, b).values;
}

PrepareOptions options_of(const Recording& recording) {
  PrepareOptions options;
  options.rate = recording.rate;
  options.settings = recording.settings;
  return options;
}

Result<Done> rebuild(const Recording& recording, const std::vector<BodyPick>& picks,
                     Session& session, bool quiet) {
  apply_picks(picks, session.scene);
  PrepareOptions options = options_of(recording);
  options.expected_poses = expected_poses(session.scene);
  Result<Simulation> made = prepare_with_bar(session.scene, options, quiet);
  if (!made) {
    return made.error();
  }
  carry_over(session.simulation.world, made.value().world);
  session.simulation = std::move(made).value();
  return Done{};
}

}  // namespace

Recording recording_head(const SceneDescription& scene, const std::vector<BodyPick>& picks,
                         const PrepareOptions& options, const World& world) {
  Recording recording;
  recording.scene = scene.path;
  recording.rate = options.rate;
  recording.settings = options.settings;
  recording.scene_picks = picks_of(scene, {});
  recording.picks = picks;
  for (const ToolDescription& tool : scene.tools) {
    recording.tools.push_back(tool.node);
  }
  recording.world_hash = hash(world);
  return recording;
}

Recording begin_recording(const Session& session, const PrepareOptions& options) {
  return recording_head(session.scene, picks_of(session.scene, options), options,
                        session.simulation.world);
}

std::uint64_t steps_in(const Recording& recording) {
  // What was chosen last may have had no step: the person left before it.
  const auto pose =
      std::find_if(recording.entries.rbegin(), recording.entries.rend(),
                   [](const InputEntry& entry) { return entry.kind == InputKind::kPose; });
  return pose == recording.entries.rend() ? 0 : pose->step + 1;
}

Result<Session> open_recorded(const std::filesystem::path& scene, const Recording& recording,
                              bool quiet) {
  Result<Session> opened = open_scene(scene);
  if (!opened) {
    return opened.error();
  }
  Session& session = opened.value();
  std::vector<std::string> tools;
  for (const ToolDescription& tool : session.scene.tools) {
    tools.push_back(tool.node);
  }
  if (tools != recording.tools ||
      !std::ranges::equal(picks_of(session.scene, {}), recording.scene_picks, same_pick)) {
    return Error{
        fmt::format("{}: not the scene of the recording, which was made of {}: it has "
                    "other tools, bodies or materials",
                    scene.string(), recording.scene)};
  }
  apply_picks(recording.picks, session.scene);
  PrepareOptions options = options_of(recording);
  options.expected_poses = expected_poses(session.scene);
  Result<Simulation> made = prepare_with_bar(session.scene, options, quiet);
  if (!made) {
    return Error{scene.string() + ": " + made.error().text};
  }
  session.simulation = std::move(made).value();
  if (hash(session.simulation.world) != recording.world_hash) {
    return Error{fmt::format(
        "{}: not as it was when recorded (from {}): the scene has changed since, or another "
        "version of torsion recorded it",
        scene.string(), recording.scene)};
  }
  return opened;
}

Result<Done> replay_inputs(Replay& replay, Session& session, bool quiet) {
  const Recording& recording = *replay.recording;
  std::vector<BodyPick> picks;
  for (std::uint32_t set = 0; set < session.tool_poses.size(); ++replay.next) {
    TORSION_ASSERT(replay.next < recording.entries.size());
    const InputEntry& entry = recording.entries[replay.next];
    if (entry.kind == InputKind::kPose) {
      session.tool_poses[entry.index] = pose_of(entry);
      ++set;
    } else if (entry.kind == InputKind::kBody) {
      if (picks.empty()) {
        picks = picks_of(session.scene, {});
      }
      picks[entry.index] = pick_of(entry);
    } else if (!picks.empty()) {
      const Result<Done> done = rebuild(recording, picks, session, quiet);
      if (!done) {
        return done.error();
      }
    }
  }
  return Done{};
}

}  // namespace torsion::engine
