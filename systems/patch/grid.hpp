#pragma once

#include <span>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/patch/scratch.hpp"

namespace torsion::engine {

/// Half sides of a grid, and where its origin goes along its axes, m.
struct GridLayout {
  glm::dvec2 half_size{0.0};
  glm::dvec2 shift{0.0};
};

/// Share of a new grid's side that the loaded cells take up: no more than what leaves a free row on
/// either side, or the next step would regrid: of a contact in the middle half a cell more on
/// either side has no cell's centre in it.
double fill_of_new(std::uint32_t side);

/// The layout around what is loaded, in the grid's middle.
/// @param loaded  along the grid's axes, from its origin
GridLayout layout_around(const PlaneBox& loaded, std::uint32_t side);

/// The layout of a contact with straight rims, which then run between cells: where they run through
/// cells, those count or not as a whole, and a punch is up to a cell too long or too short, of
/// which the stiffness against turning takes the cube. Along an axis that is not sharp the rim is
/// where the pressure ends.
/// @param covered  where there is overlap, as exact as its coverage says
/// @param sharp_x, sharp_y  the rim along that axis is the overlap's; at least one
GridLayout layout_between_rims(const PlaneBox& covered, bool sharp_x, bool sharp_y,
                               std::uint32_t side);

/// Gives a grid that holds a contact the axes of the contact, if that is long, and lays it between
/// its rims, if they are straight; leaves any other as it is.
/// @param depth   m, from which cells look for the tool
/// @param loaded  m, along the axes: what carries pressure, or nothing where there is none yet
void lay_along_contact(const Grid& grid, const RegionPoints& contact, double depth,
                       const glm::dvec2& loaded);

/// Moves the grid's origin along its own plane and back to the body's surface. The material's
/// motion, which is given for the origin, is given for the new origin from then on.
void shift_origin(const Grid& grid, const glm::dvec2& shift);

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

/// Pressures of a contact that has grown alike to itself. Of cells that move_cells has moved.
/// @param middle  of the contact, in the old grid's cells
/// @param ratio   by which it has grown along the axes
/// @param more    by which pressures have
void grow_pressures(const Grid& grid, const PatchScratch& scratch, const CellMove& move,
                    const glm::dvec2& middle, const glm::dvec2& ratio, double more);

/// Adds the pressures and tractions of another region's cells, by linear interpolation. Where both
/// regions carry pressure, as cells do that were as near to the one as to the other, the larger
/// counts.
/// @param move    from that region's grid to this one's
/// @param others  (side x side)
void add_cells(const Grid& grid, const CellMove& move, std::span<const CellTraction> others);

/// Lays a new grid of contact model `patch` by the overlap alone, and finds its cells: where the
/// tool's samples lie must not matter, or mirrored motions would differ.
/// @param start_depth  m: of a point of the contact, where cells begin to look for the tool
void center_patch(const Grid& grid, const RegionPoints& contact, double start_depth);

// The grids of regions with contact model `patch`. Their cells stay where they are on the body as
// long as they can: displacements belong to places on the body, and every move of the grid that is
// not by whole cells smooths them.

/// Where a contact's middle is laid in a grid, in cells from its corner: in the middle of a column
/// and between two rows. Each axis
/// alone is mirror-symmetric, but the two staircases of the contact's rim differ: where they are
/// the same their errors add up, to three times as much in the torque.
glm::dvec2 patch_middle(std::uint32_t side);

/// The same place from the grid's origin, over its half sides.
glm::dvec2 middle_in_grid(std::uint32_t side);

/// Columns at the grid's left that stay empty for that, so that as many are on either side of the
/// middle: 1, or 0 where the grid is too coarse to spare one or odd already.
std::uint32_t patch_spare(std::uint32_t side);

/// ContactLaw::follow. Moves a region's grid by whole cells, or regrids, when the cells that
/// carry pressure come to its edge, leave much of it empty, or when a point of the contact lies
/// outside that the pressure cannot keep away. What the cells hold goes with their places. A region
/// without force begins anew.
void follow_patch(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// ContactLaw::find_cells. The grid of a new region is found by its overlap; later on what sticks
/// is seen where it will have gone with the tool.
void find_patch_cells(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Lays a region's grid around its loaded cells at once.
void regrid_around_loaded(StepContext& context, std::uint32_t region, const RegionPoints& contact);

}  // namespace torsion::engine
