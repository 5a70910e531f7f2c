#pragma once

#include <vector>

#include "app/live/recording.hpp"
#include "ecs/scene_description.hpp"
#include "scenes/write_motion.hpp"

namespace torsion::engine {

/// The poses of a recording as keys of the scene's tool nodes, in the frames of their parents; one
/// key a step, but none in the middle of a rest.
std::vector<NodeMotion> recorded_motions(const Recording& recording, const SceneDescription& scene);

}  // namespace torsion::engine
