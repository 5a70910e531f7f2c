#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "ecs/scene_description.hpp"
#include "systems/step.hpp"

namespace torsion::engine {

/// A scene, its simulation, and where its tools are in the step to come.
struct Session {
  SceneDescription scene;
  Simulation simulation;
  std::vector<Pose> tool_poses;  // (tools)
};

/// Loads a scene; its simulation is still empty. The error has all problems of the file, one a
/// line.
Result<Session> open_scene(const std::filesystem::path& path);

/// Loads and prepares a scene, with a bar where that takes long. The error has all problems of the
/// file, one a line.
/// @param quiet     no bar
/// @param settings  values over what the file says (app/scene_settings.hpp)
Result<Session> open_session(const std::filesystem::path& path, const PrepareOptions& options,
                             bool quiet, std::span<const std::string> settings = {});

/// prepare() with a bar where that takes long.
Result<Simulation> prepare_with_bar(const SceneDescription& scene, const PrepareOptions& options,
                                    bool quiet);

/// The time of the step to come, s.
double next_time(const World& world);

/// The tools' poses of the step to come, where their animations hold them.
void set_scripted_poses(Session& session);

/// One step with the tools where their animations hold them at its time.
void step_scripted(Session& session);

/// How many steps `seconds` take.
std::uint64_t steps_in(const Session& session, double seconds);

}  // namespace torsion::engine
