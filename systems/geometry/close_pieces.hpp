#pragma once

// Flat pieces of a surface as one triangle mesh.

#include <optional>
#include <vector>

#include "ecs/surface.hpp"
#include "systems/geometry/cut_facets.hpp"

namespace torsion {

/// The pieces as one mesh, without places where an edge ends in the middle of another: nothing
/// where they bound no solid.
/// @param pieces  convex; as they were cut, so that neighbours may have different corners along one
///                edge
/// @param same    m: corners nearer than a few times that are one
std::optional<SurfaceMesh> close_pieces(const std::vector<Polygon>& pieces, double same);

}  // namespace torsion
