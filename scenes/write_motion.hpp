#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ecs/components.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// Keys of one node of a scene, in the frame of its parent. Linear between them.
struct NodeMotion {
  std::string node;
  glm::dvec3 scale{1.0};     // of the node, which stays
  std::vector<float> times;  // s, strictly increasing
  std::vector<Pose> poses;   // (times)
};

/// The bytes of the scene in `path` with these motions in place of what moved these nodes; all else
/// stays, buffers inside. Fails where the file cannot be read or has no such node.
Result<std::string> with_motions(const std::filesystem::path& path,
                                 const std::vector<NodeMotion>& motions, bool binary);

}  // namespace torsion::engine
