#include "device/scripted_motion.hpp"

#include <algorithm>

namespace torsion::engine {

namespace {

/// Where a pose of the world would be if the body were at rest and all else moved about it.
Pose seen_from_rest(const BodyDescription& body, double time, const Pose& pose) {
  const Pose now = scripted_pose(body.script, time);
  const glm::dquat back = body.pose.rotation * glm::conjugate(now.rotation);
  return {body.pose.position + back * (pose.position - now.position), back * pose.rotation};
}

}  // namespace

std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene) {
  constexpr int kTimes = 60;
  const auto moves = [](const BodyDescription& body) {
    return !body.script.links.empty();
  };
  const bool moved_bodies = std::ranges::any_of(scene.bodies, moves);
  const auto is_animated = [moved_bodies](const ToolDescription& tool) {
    return tool.device == "animation" && (moved_bodies || tool.script.end_time > 0.0);
  };
  std::vector<std::vector<Pose>> poses;
  // Several bodies of which one moves have no place in which all of them are at rest.
  if ((moved_bodies && scene.bodies.size() > 1) || !std::ranges::all_of(scene.tools, is_animated)) {
    return poses;
  }
  for (int k = 0; k <= kTimes; ++k) {
    std::vector<Pose>& at_time = poses.emplace_back();
    const double time = scene.duration * k / kTimes;
    for (const ToolDescription& tool : scene.tools) {
      const Pose pose = scripted_pose(tool.script, time);
      at_time.push_back(moved_bodies ? seen_from_rest(scene.bodies[0], time, pose) : pose);
    }
  }
  return poses;
}

}  // namespace torsion::engine
