#include "device/scripted_motion.hpp"

#include <algorithm>

namespace torsion::engine {

std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene) {
  constexpr int kTimes = 60;
  const auto is_animated = [](const ToolDescription& tool) {
    return tool.device == "animation" && tool.script.end_time > 0.0;
  };
  std::vector<std::vector<Pose>> poses;
  const bool moved_bodies = std::ranges::any_of(
      scene.bodies, [](const BodyDescription& body) { return !body.script.links.empty(); });
  if (moved_bodies || !std::ranges::all_of(scene.tools, is_animated)) {
    return poses;
  }
  for (int k = 0; k <= kTimes; ++k) {
    std::vector<Pose>& at_time = poses.emplace_back();
    for (const ToolDescription& tool : scene.tools) {
      at_time.push_back(scripted_pose(tool.script, scene.duration * k / kTimes));
    }
  }
  return poses;
}

}  // namespace torsion::engine
