#pragma once

#include <glm/vec3.hpp>

#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// A drawn mesh with fewer vertices: those of the same place and normal are one, and away from
/// `center` so are all those of a cell whose normals point to the same side (vertex clustering).
/// @param fine  m: from the centre so far no shape is lost
/// @param cell  m: width of a cell beyond
/// @pre it has one material and no textures
DrawMesh coarse_mesh(const DrawMesh& mesh, const glm::vec3& center, float fine, float cell);

}  // namespace torsion::engine
