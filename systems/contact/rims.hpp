#pragma once

// Rims: where a tool's underside ends at a steep side, as a punch's does.

#include "systems/contact/grid_cells.hpp"

namespace torsion::engine {

/// Where the tool's underside ends at a steep side, as a punch's does, cells count with the share
/// that lies under it; by their centres alone they would come and go as wholes, and a contact that
/// turns over its cells would lose the friction of one after another. Cells whose centres are
/// beside the tool are put on its underside, carried on over them with its slopes; those under a
/// rounded edge in part, the more the steeper it is there.
/// The side is looked for half a cell's diagonal above the underside, where it is nearer than that
/// wherever it cuts the cell, and followed down along its plane.
/// @pre   find_tool_surface has left the cells' places and slopes in ContactScratch::cell_columns
/// @post  CellColumns::rim_share and rim_bearing are found, when there are any
/// @return whether there are any
bool find_rims(const Grid& grid);

/// Takes from coverage and bearing what is not under the tool.
void take_rims(const CellColumns& columns);

/// CellGeometry::bearing of a cell that only partly lies under a face. What it carries it carries
/// on a smaller area, and deflects by more under it. The softness that it has beyond a whole
/// cell's, kRimSoftness (1 / bearing - 1) times what its own influence on itself is, makes a punch
/// whose rim runs through a row of cells as stiff as in between those a row narrower and wider
/// (rim_stiffness_test.cpp): a row of cells that are long across the rim is the softer for that.
/// @param share   of the cell under the face
/// @param aspect  the cell's length across the rim over that along it
double bearing_of(double share, double aspect);

inline constexpr double kRimSoftness = 1.3;

/// Of a cell's length: so much farther out a face's rim is laid for the bearing. By this a punch on
/// a grid of cells with one pressure each is narrower than it is, on either side (likewise).
inline constexpr double kRimBeyond = 0.13;

}  // namespace torsion::engine
