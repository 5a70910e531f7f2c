#pragma once

// Edges of a body within a region's grid: its faces lie askew there, and beyond them the tool
// reaches down beside the body.

#include "systems/contact/grid_cells.hpp"

namespace torsion::engine {

/// Where the body's nearest face to a cell lies askew, the column over the cell may leave the body
/// through another one: takes that face. The nearest one alone, continued beyond the edge, would
/// make the overlap deeper than it is.
/// @pre   CellColumns has the cells' distances to the body
/// @post  and those to the faces that their columns leave by, along their normals
/// @return whether there are such cells
bool find_upper_faces(const Grid& grid);

/// Beside an edge of the body the nearest point may lie on the body's side. The distance to it
/// gives the share of the cell that is over the body; the depth is measured under the face that the
/// tool presses on, continued as a plane.
/// @pre   CellColumns has the cells' depths and coverage under their nearest faces
/// @post  CellColumns::over_body and under_face, ContactScratch::body_edges' face are found
void cut_at_body_edges(const Grid& grid);

}  // namespace torsion::engine
