#pragma once

#include "ecs/surface.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// Joins vertices at the same place, for files split them where normals differ, and drops triangles
/// that this leaves without area and vertices that nothing uses.
/// @param tolerance  m: vertices nearer than this are one
SurfaceMesh weld(const SurfaceMesh& mesh, double tolerance);

/// Volume inside a closed mesh, m^3; negative where it is inside out (divergence theorem).
double enclosed_volume(const SurfaceMesh& mesh);

/// Welds `mesh` and checks that it bounds a solid: every edge between two triangles that run along
/// it in opposite directions, and volume. A mesh that is inside out is turned about. What is wrong
/// is said with its place.
SurfaceMesh closed_surface(const SurfaceMesh& mesh, const std::string& where,
                           const ProblemList& problems);

}  // namespace torsion::engine
