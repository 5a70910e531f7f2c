#pragma once

#include <span>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/patch/scratch.hpp"

namespace torsion {

/// Where the cells of a new grid lie among those of the old one, both counted from the centre of
/// their first cell: old = origin + by * new.
struct CellMove {
  glm::dvec2 origin{0.0};
  glm::dmat2 by{1.0};
  glm::dmat2 turn{1.0};  // vector along the old axes = turn * vector along the new ones

  /// True where cells only change places, so that nothing is interpolated.
  [[nodiscard]] bool keeps_cells() const { return by == glm::dmat2(1.0); }
};

/// Between two grids of so many cells a side, whose normals are the same or nearly so.
CellMove move_between(const RegionFrame& before, const RegionFrame& now, std::uint32_t side);

/// Gives the cells of a region with contact model `patch`, whose grid has moved, what the old cells
/// around their places held: pressure and traction by linear interpolation, the displacement at
/// which friction holds the surface by a cubic one. Where the old cells slipped nothing holds it:
/// on quite other cells the elastic displacement differs by more than a step's slip, and held at
/// the old one, cells would stick. With `ahead` they are held so far ahead along their way that
/// they slip on at the friction limit in the same direction, whatever the new cells displace.
/// @param depth  m, from which cells look for the tool
/// @param ahead  m; 0 where cells are so like the old ones that they may stick
void move_cells(const Grid& grid, PatchScratch& scratch, const CellMove& move, double depth,
                double ahead);

/// Adds the pressures and tractions of another region's cells, by linear interpolation. Where both
/// regions carry pressure, as cells do that were as near to the one as to the other, the larger
/// counts.
/// @param move    from that region's grid to this one's
/// @param others  (side x side)
void add_cells(const Grid& grid, const CellMove& move, std::span<const CellTraction> others);

}  // namespace torsion
