#pragma once

#include "systems/grid_cells.hpp"

namespace torsion {

/// Area, depths, pressure centre and mean normal from the cells.
RegionGeometry summarize_cells(const Grid& grid);

}  // namespace torsion
