#pragma once

#include <tiny_gltf.h>

#include "scenes/problem.hpp"

namespace torsion::engine {

/// Checks what the buffers hold: sparse indices in order, finite positions, attributes of one
/// length, indices of vertices that exist, times that rise, as many values as keys.
/// @pre the structure and the extents of `model` were found right
void check_gltf_content(const tinygltf::Model& model, const ProblemList& problems);

}  // namespace torsion::engine
