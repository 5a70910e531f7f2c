#include "device/scripted_motion.hpp"

#include <algorithm>
#include <cstddef>

namespace torsion::engine {

namespace {

constexpr int kTimes = 60;

double time_of(const SceneDescription& scene, std::size_t row) {
  return scene.duration * static_cast<double>(row) / kTimes;
}

bool moves(const BodyDescription& body) {
  return !body.script.links.empty();
}

/// Where a pose of the world would be if the body were at rest and all else moved about it.
Pose seen_from_rest(const BodyDescription& body, double time, const Pose& pose) {
  const Pose now = scripted_pose(body.script, time);
  const glm::dquat back = body.pose.rotation * glm::conjugate(now.rotation);
  return {body.pose.position + back * (pose.position - now.position), back * pose.rotation};
}

}  // namespace

std::vector<std::vector<Pose>> scripted_poses(const SceneDescription& scene) {
  const bool moved_bodies = std::ranges::any_of(scene.bodies, moves);
  const auto is_animated = [moved_bodies](const ToolDescription& tool) {
    return tool.device == "animation" && (moved_bodies || tool.script.end_time > 0.0);
  };
  std::vector<std::vector<Pose>> poses;
  if (!std::ranges::all_of(scene.tools, is_animated)) {
    return poses;
  }
  for (std::size_t row = 0; row <= kTimes; ++row) {
    std::vector<Pose>& at_time = poses.emplace_back();
    for (const ToolDescription& tool : scene.tools) {
      at_time.push_back(scripted_pose(tool.script, time_of(scene, row)));
    }
  }
  return poses;
}

std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene) {
  std::vector<std::vector<Pose>> poses = scripted_poses(scene);
  if (!std::ranges::any_of(scene.bodies, moves)) {
    return poses;
  }
  if (scene.bodies.size() > 1) {
    return {};  // no place in which all of them are at rest
  }
  for (std::size_t row = 0; row < poses.size(); ++row) {
    for (Pose& pose : poses[row]) {
      pose = seen_from_rest(scene.bodies[0], time_of(scene, row), pose);
    }
  }
  return poses;
}

}  // namespace torsion::engine
