#pragma once

#include "systems/contact/grid_cells.hpp"

namespace torsion {

/// Area, depths, centroid and mean normal from the cells.
Overlap summarize_cells(const Grid& grid);

}  // namespace torsion
