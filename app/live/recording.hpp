#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/live/input_entry.hpp"
#include "app/live/rebuild.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// A run that can be had again: how its world was prepared, and everything that went in.
struct Recording {
  std::string scene;                  // path, as it was given
  double rate = 1000.0;               // Hz
  Settings settings;                  // asked for; grid_side 0: as the models need
  std::vector<BodyPick> scene_picks;  // (bodies) as the scene file says
  std::vector<BodyPick> picks;        // (bodies) at the start
  std::vector<std::string> tools;
  std::uint64_t world_hash = 0;  // hash() of the prepared world: scene, models and this build
  std::vector<InputEntry> entries;
};

/// A recording without entries yet.
/// @param scene  as its file says
/// @param picks  of which `world` was prepared
Recording recording_head(const SceneDescription& scene, const std::vector<BodyPick>& picks,
                         const PrepareOptions& options, const World& world);

/// The recording of a session that has taken no step yet; entries are still to come.
Recording begin_recording(const Session& session, const PrepareOptions& options);

/// Steps that a recording holds.
std::uint64_t steps_in(const Recording& recording);

/// Loads and prepares a scene as it was when recorded. Fails with a clear word where it is another
/// scene, or the program prepares it otherwise than the one that recorded.
Result<Session> open_recorded(const std::filesystem::path& scene, const Recording& recording,
                              bool quiet);

/// Where a replay stands. `next` is the first entry that is still to be used.
struct Replay {
  const Recording* recording = nullptr;
  std::size_t next = 0;
};

/// Puts what went into the next step into the session: tool poses, and a new world where models
/// were switched. Fails where that cannot be prepared.
/// @pre the recording still has a step
Result<Done> replay_inputs(Replay& replay, Session& session, bool quiet);

}  // namespace torsion::engine
