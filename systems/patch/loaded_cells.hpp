#pragma once

#include <glm/vec2.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/region_grid.hpp"

namespace torsion::engine {

/// Share of a rim's cell that has to be in contact for it to count.
inline constexpr double kMostly = 0.5;

/// A box of cells; `end` is one past the last.
struct CellBox {
  glm::ivec2 first{0};
  glm::ivec2 end{0};
};

/// The cells with pressure. Of rim cells, those that are mostly in contact.
struct LoadedArea {
  CellBox box;  // `end` is zero when there are none
  CellMoments moments;
  CellBits cells{};
};

/// Whether a cell carries pressure and counts for the contact's extent.
/// @param least  share of it that is in contact
inline bool is_loaded(const CellTraction& traction, const CellGeometry& geometry, double least) {
  return traction.pressure > 0.0 && geometry.coverage >= least;
}

/// @param least  share of a cell that is in contact
LoadedArea loaded_cells(const Grid& grid, double least);

inline glm::dvec2 cell_size(const Grid& grid) {
  return 2.0 * cell_half_size(grid);
}

/// Whether a box takes in cells at the grid's edge.
bool reaches_edge(const Grid& grid, const CellBox& box);

/// Whether a box, m, lies in the grid with a free row and column on every side.
bool holds(const Grid& grid, const PlaneBox& box);

/// The box in m, from the grid's origin.
PlaneBox extent_of(const Grid& grid, const CellBox& box);

/// The loaded cells' extent along axes that are turned from the grid's, m. Their rim runs between
/// cells; askew to the axes, the outermost of many centres is nearer to the rim than half a cell.
PlaneBox extent_along(const Grid& grid, double least, double angle);

}  // namespace torsion::engine
