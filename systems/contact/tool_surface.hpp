#pragma once

#include "systems/contact/grid_cells.hpp"

namespace torsion::engine {

/// Puts the cells' places of the last step on the tool's underside. Leaves them and the slopes
/// there, of the last step of Newton's method but one, in ContactScratch::cell_columns.
void find_tool_surface(const Grid& grid);

/// The parts of a tool or body that can be nearest to what of a surface lies under the cells'
/// centres and below the rest surface.
/// @param origin  m, of the grid, in the parts' frame
std::span<const std::uint32_t> parts_under(const Grid& grid, Range parts, const glm::dvec3& origin);

}  // namespace torsion::engine
