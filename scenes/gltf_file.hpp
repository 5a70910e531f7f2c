#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <tiny_gltf.h>

#include "scenes/problem.hpp"

namespace torsion::engine {

/// Reads and checks a .gltf or .glb: JSON and GLB framing before tinygltf sees it, then every
/// index, count, type and extent of what tinygltf made of it. Of what this returns, every index
/// that a scene reader follows is in range, every accessor lies inside its buffer, and the nodes
/// are trees. Appends to `found`; nothing is returned when it appended any.
std::optional<tinygltf::Model> read_gltf_file(const std::filesystem::path& path,
                                              std::vector<Problem>& found);

}  // namespace torsion::engine
