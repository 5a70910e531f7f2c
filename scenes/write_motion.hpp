#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tiny_gltf.h>

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

/// Puts these motions in place of what moved their nodes, in an animation and a buffer of their
/// own.
/// @pre each has poses, and its node is there
void add_motions(tinygltf::Model& model, const std::string& animation,
                 const std::vector<NodeMotion>& motions);

/// The bytes of a model, buffers inside.
/// @param path  for the error
Result<std::string> written(tinygltf::Model& model, bool binary, const std::filesystem::path& path);

/// The bytes of the scene in `path` with these motions in place of what moved these nodes; all else
/// stays, buffers inside. Fails where the file cannot be read or has no such node.
Result<std::string> with_motions(const std::filesystem::path& path,
                                 const std::vector<NodeMotion>& motions, bool binary);

}  // namespace torsion::engine
