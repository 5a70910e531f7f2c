#pragma once

#include <string>
#include <vector>

#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/world.hpp"
#include "systems/model/options.hpp"

namespace torsion {

/// A scene's tables, filled.
struct PreparedWorld {
  World world;
  std::vector<ModelChoice> choices;       // (bodies)
  std::vector<std::string> united_nodes;  // whose meshes overlap and count as one solid
};

/// Load-time work: distance fields, surface samples, anchors, beam sections; then all tables,
/// filled. Bodies and tools get the rows that they have in `scene`. Fails with a message that names
/// the node.
Result<PreparedWorld> prepare_world(const SceneDescription& scene, const PrepareOptions& options);

}  // namespace torsion
