#include "app/session.hpp"

#include <algorithm>
#include <cmath>

#include "app/drawn_detail.hpp"
#include "app/progress.hpp"
#include "app/scene_settings.hpp"
#include "device/scripted_motion.hpp"
#include "scenes/load_gltf.hpp"

namespace torsion::engine {

Result<Session> open_scene(const std::filesystem::path& path) {
  LoadedScene loaded = load_gltf(path);
  if (!loaded.scene) {
    return Error{to_text(loaded.problems)};
  }
  Session session;
  session.scene = std::move(*loaded.scene);
  session.tool_poses.resize(session.scene.tools.size());
  return session;
}

Result<Session> open_session(const std::filesystem::path& path, const PrepareOptions& options,
                             bool quiet, std::span<const std::string> settings) {
  Result<Session> session = open_scene(path);
  if (!session) {
    return session.error();
  }
  if (const Result<Done> done = apply_settings(settings, session.value().scene); !done) {
    return done.error();
  }
  PrepareOptions informed = options;
  informed.expected_poses = expected_poses(session.value().scene);
  Result<Simulation> simulation = prepare_with_bar(session.value().scene, informed, quiet);
  if (!simulation) {
    return Error{path.string() + ": " + simulation.error().text};
  }
  session.value().simulation = std::move(simulation).value();
  refine_drawn_bodies(session.value().scene, session.value().simulation.world.model,
                      informed.expected_poses);
  return session;
}

Result<Simulation> prepare_with_bar(const SceneDescription& scene, const PrepareOptions& options,
                                    bool quiet) {
  Progress bar("finding the body's compliance", quiet);
  PrepareOptions shown = options;
  shown.progress = [&bar](double share) {
    bar.show(share);
  };
  return prepare(scene, shown);
}

double next_time(const World& world) {
  return static_cast<double>(world.state.clock.step) * world.model.dt;
}

void set_scripted_poses(Session& session) {
  const double time = next_time(session.simulation.world);
  for (std::size_t tool = 0; tool < session.tool_poses.size(); ++tool) {
    session.tool_poses[tool] = scripted_pose(session.scene.tools[tool].script, time);
  }
}

void step_scripted(Session& session) {
  set_scripted_poses(session);
  step(session.simulation, session.tool_poses);
}

std::uint64_t steps_in(const Session& session, double seconds) {
  const double dt = session.simulation.world.model.dt;
  return static_cast<std::uint64_t>(std::llround(seconds / dt));
}

}  // namespace torsion::engine
