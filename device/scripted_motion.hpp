#pragma once

#include <vector>

#include "ecs/components.hpp"
#include "ecs/motion_script.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// Where the tools will be in the world at equal intervals of the scene's animations, (times) of
/// (tools). Empty where something else than an animation moves a tool, or nothing moves at all.
std::vector<std::vector<Pose>> scripted_poses(const SceneDescription& scene);

/// The same as the body sees them that an animation moves: as if it were at rest and all else moved
/// about it. For what is chosen by a body's contacts. Empty also where one of several bodies moves.
std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene);

}  // namespace torsion::engine
