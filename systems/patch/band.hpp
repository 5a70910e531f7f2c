#pragma once

// New regions that are narrow bands, as of an edge on a face: the grid is found along their length.

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/scratch.hpp"

namespace torsion::engine {

/// Whether the overlap is a band that the grid cuts off, or that is narrower than cells.
bool is_narrow_band(const Grid& grid, const CellBits& covered);

/// Passes over a grid along a band that reaches beyond it, as of an edge on a face. Square cells
/// that the length fits are wider than the band and hardly see it, so only the length grows.
/// @param start_depth  m, from which cells look for the tool
void find_band(const Grid& grid, const RegionPoints& contact, double start_depth);

}  // namespace torsion::engine
