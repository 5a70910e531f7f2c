#include "app/live/recorded_motion.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include "device/scripted_motion.hpp"

namespace torsion::engine {
namespace {

/// Where the tool's parent is: place, turn and scale of all links above the tool's own.
struct Parent {
  glm::dmat4 to_world{1.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
};

Parent parent_at(const MotionScript& script, double time) {
  Parent parent;
  for (std::size_t i = 0; i + 1 < script.links.size(); ++i) {
    const MotionLink& link = script.links[i];
    const glm::dvec3 translation = link.animated_translation.empty()
                                       ? link.translation
                                       : translation_at(link.animated_translation, time);
    const glm::dquat rotation =
        link.animated_rotation.empty() ? link.rotation : rotation_at(link.animated_rotation, time);
    parent.to_world = glm::scale(
        glm::translate(parent.to_world, translation) * glm::mat4_cast(rotation), link.scale);
    parent.rotation = parent.rotation * rotation;
  }
  return parent;
}

bool same_pose(const Pose& a, const Pose& b) {
  return a.position == b.position && a.rotation == b.rotation;
}

Pose in_parent(const Pose& world, const Parent& parent) {
  return {glm::dvec3(glm::inverse(parent.to_world) * glm::dvec4(world.position, 1.0)),
          glm::normalize(glm::conjugate(parent.rotation) * world.rotation)};
}

}  // namespace

std::vector<NodeMotion> recorded_motions(const Recording& recording,
                                         const SceneDescription& scene) {
  std::vector<NodeMotion> motions;
  for (const ToolDescription& tool : scene.tools) {
    NodeMotion motion;
    motion.node = tool.node;
    motion.scale = tool.script.links.empty() ? glm::dvec3(1.0) : tool.script.links.back().scale;
    motions.push_back(std::move(motion));
  }
  for (const InputEntry& entry : recording.entries) {
    if (entry.kind != InputKind::kPose) {
      continue;
    }
    NodeMotion& motion = motions[entry.index];
    const double time = static_cast<double>(entry.step) / recording.rate;
    const Pose pose = in_parent(pose_of(entry), parent_at(scene.tools[entry.index].script, time));
    const std::size_t keys = motion.poses.size();
    if (keys >= 2 && same_pose(motion.poses[keys - 1], pose) &&
        same_pose(motion.poses[keys - 2], pose)) {
      motion.times.back() = static_cast<float>(time);  // the rest goes on
      continue;
    }
    motion.times.push_back(static_cast<float>(time));
    motion.poses.push_back(pose);
  }
  return motions;
}

}  // namespace torsion::engine
