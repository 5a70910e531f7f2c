#pragma once

// The normal of an overlap that an edge of the body, or of the tool, is in.

#include <glm/vec3.hpp>

#include "systems/contact/grid_cells.hpp"

namespace torsion::engine {

/// The normal that a grid turns to where the body's faces within it lie askew: towards the one
/// along which the volume of the overlap grows the most when the tool shifts into the body. That is
/// the sum of the areas of the body's faces inside the tool times their outward normals (the
/// divergence theorem), also of a side beside an edge, of which the cells see the height alone. A
/// force along it that goes with the volume has a potential.
/// @param mean  unit: mean normal of the faces that the cells see; all in the grid's axes
/// @pre   find_cells, and ContactScratch::body_edges.askew > 0
glm::dvec3 normal_beside_edges(const Grid& grid, const glm::dvec3& mean);

}  // namespace torsion::engine
