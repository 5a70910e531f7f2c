#pragma once

#include <vector>

#include "ecs/components.hpp"
#include "ecs/motion_script.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// The frame at the end of a script's links at `time` [s], without their scale: what an animation
/// holds the tool at. Before the first key of a channel its first value holds, after the last its
/// last (glTF 2.0, 3.11). Allocates nothing; the same time gives the same bits.
Pose scripted_pose(const MotionScript& script, double time);

/// The value of a channel of translations at `time` [s], m. @pre the channel is not empty
glm::dvec3 translation_at(const KeyedChannel& channel, double time);

/// The value of a channel of rotations at `time` [s]. @pre the channel is not empty
glm::dquat rotation_at(const KeyedChannel& channel, double time);

/// Where the tools will be at equal intervals of the scene's animations, (times) of (tools); empty
/// where something else than an animation moves one of them.
std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene);

}  // namespace torsion::engine
