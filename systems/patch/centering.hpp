#pragma once

#include "systems/contact/grid_cells.hpp"

namespace torsion {

/// Lays a new grid of contact model `patch` by the overlap alone, and finds its cells: where the
/// tool's samples lie must not matter, or mirrored motions would differ.
/// @param start_depth  m: of a point of the contact, where cells begin to look for the tool
void center_patch(const Grid& grid, const RegionPoints& contact, double start_depth);

}  // namespace torsion
