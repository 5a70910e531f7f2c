#pragma once

#include <optional>
#include <string>

#include "ecs/components.hpp"
#include "ecs/surface.hpp"
#include "scenes/mesh_parts.hpp"
#include "scenes/node_tree.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// The kind that a value of torsion_shape names. @pre it is one of the allowed values
ShapeKind shape_kind(const std::string& name);

/// The exact shape that fills the box from `lowest` to `highest` [m, mesh frame, before scaling]. A
/// box that does not suit the shape within 1 % is a problem.
/// @param to_owner  mesh to owner's frame
std::optional<ShapePart> fit_shape(ShapeKind kind, const glm::dvec3& lowest,
                                   const glm::dvec3& highest, const NodeTransform& to_owner,
                                   const std::string& where, const ProblemList& problems);

/// A closed mesh of the surface of an exact shape, in its owner's frame; extremes lie on it.
/// @param fineness  facets along each side of the cube whose faces are bent to the shape, even
SurfaceMesh tessellate(const ShapePart& shape, int fineness = 24);

/// The same for drawing: where faces meet at more than 40 degrees, as at the sides of a box, each
/// has vertices of its own, so that the edge looks sharp.
MeshTriangles drawn_mesh(const SurfaceMesh& surface);

}  // namespace torsion::engine
