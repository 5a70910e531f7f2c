#pragma once

#include <vector>

#include "ecs/components.hpp"
#include "ecs/motion_script.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// Where the tools will be at equal intervals of the scene's animations, (times) of (tools); empty
/// where something else than an animation moves one of them, or an animation moves a body.
std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene);

}  // namespace torsion::engine
