#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ecs/result.hpp"

namespace torsion::engine {

/// What is to be added to somebody's glTF, so that it is a scene.
struct PhysicsToAdd {
  std::string body;   // node that is to be elastic; empty: the only one with a mesh
  std::string tool;   // node that is to be the tool; empty: a ball is added above the body
  std::string shape;  // torsion_shape of the body; empty: its mesh
};

struct PhysicsAdded {
  std::string bytes;                 // of the file
  std::vector<std::string> assumed;  // what was said of nothing, in words
};

/// The glTF in `path` with the keys of docs/scenes.md; all else stays, buffers inside. The ball
/// stands above the highest place of the body, has 0.15 of its least side as radius, presses down
/// by a quarter of that and turns by 40 degrees and back.
/// @param binary  .glb, else .gltf
/// Fails where the file cannot be read, has no such node, or several could be meant.
Result<PhysicsAdded> with_physics(const std::filesystem::path& path, const PhysicsToAdd& add,
                                  bool binary);

}  // namespace torsion::engine
