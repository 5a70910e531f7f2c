#pragma once

#include "systems/contact/grid_cells.hpp"

namespace torsion {

/// Area, depths, pressure centre and mean normal from the cells.
RegionGeometry summarize_cells(const Grid& grid);

}  // namespace torsion
