#pragma once

#include <nlohmann/json.hpp>

#include "scenes/problem.hpp"

namespace torsion::engine {

/// Checks the JSON of a glTF before any library follows it: version, required extensions, that
/// arrays and members have the right kinds, that every index is a whole number in range (tinygltf
/// cuts 2^32 to 0 and lets negative ones pass), transforms, primitive modes, animations, and that
/// the nodes are trees.
void check_gltf_structure(const nlohmann::json& document, const ProblemList& problems);

}  // namespace torsion::engine
