#pragma once

#include <vector>

#include "ecs/components.hpp"
#include "ecs/motion_script.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// Where the tools will be at equal intervals of the scene's animations, (times) of (tools), as
/// seen from a body that an animation moves: where that is at rest. Empty where something else than
/// an animation moves a tool, or an animation moves one of several bodies.
std::vector<std::vector<Pose>> expected_poses(const SceneDescription& scene);

}  // namespace torsion::engine
