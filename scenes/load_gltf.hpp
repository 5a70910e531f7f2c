#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "ecs/scene_description.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// What a scene file holds, or everything that is wrong with it.
struct LoadedScene {
  std::optional<SceneDescription> scene;  // nothing where there are problems
  std::vector<Problem> problems;          // all of them, in the order of the file
};

/// Reads a .gltf or .glb by the conventions of docs/scenes.md. Never throws, never reads outside
/// the folder of the file.
LoadedScene load_gltf(const std::filesystem::path& path);

}  // namespace torsion::engine
