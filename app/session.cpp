#include "app/session.hpp"

#include <cmath>

#include "device/scripted_motion.hpp"
#include "scenes/load_gltf.hpp"
#include "systems/fault.hpp"

namespace torsion {

Result<Session> open_session(const std::filesystem::path& path, const PrepareOptions& options) {
  LoadedScene loaded = load_gltf(path);
  if (!loaded.scene) {
    return Error{to_text(loaded.problems)};
  }
  Result<Simulation> simulation = prepare(*loaded.scene, options);
  if (!simulation) {
    return Error{path.string() + ": " + simulation.error().text};
  }
  Session session{std::move(*loaded.scene), std::move(simulation).value(), {}};
  session.tool_poses.resize(session.scene.tools.size());
  return session;
}

void step_scripted(Session& session) {
  const Clock& clock = session.simulation.world.clock.at<Clock>(0);
  const double time = static_cast<double>(clock.step) * clock.dt;
  for (std::size_t tool = 0; tool < session.tool_poses.size(); ++tool) {
    session.tool_poses[tool] = scripted_pose(session.scene.tools[tool].script, time);
  }
  step(session.simulation, session.tool_poses);
}

std::uint64_t steps_in(const Session& session, double seconds) {
  const double dt = session.simulation.world.clock.at<Clock>(0).dt;
  return static_cast<std::uint64_t>(std::llround(seconds / dt));
}

std::string faults_text(std::uint32_t faults) {
  std::string text;
  for (const Fault fault : kAllFaults) {
    if (raised(faults, fault)) {
      text += std::string(fault_text(fault)) + "\n";
    }
  }
  return text;
}

}  // namespace torsion
