#pragma once

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion {

/// Lays a new region's grid: in the body's tangent plane at the deepest of the cluster's points,
/// just around them. The axes come from the body frame, so a scene that is turned as a whole gives
/// a grid that is turned with it.
void place_new_grid(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// The deepest of the region's contact points; depth 0 where there are none.
ContactPoint deepest_of_cluster(const Grid& grid, const RegionPoints& contact);

/// A grid that is laid anew may see more of the body than the one before it, by whose cells it is
/// turned: of a face that comes to lie on a body the first to touch is an edge, whose normal is
/// another one, and over the whole face that would be a depth of its own.
void look_along_normal(const Grid& grid, const RegionPoints& contact);

// Of contact models whose grid is found by the overlap alone.

/// Moves a region's grid along with its overlap: centre, size and normal follow what the last
/// step's cells found, and the cluster's points lie on it. The x axis turns with the normal and not
/// about it, and along a long contact.
void follow_overlap(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Finds the overlap's cells, and fits the grid to them.
void find_overlap(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Moves a region's grid along with its contact, as its contact model does.
void follow_contact(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Finds, for every cell of every region, the tool's surface along the normal and how deep it is
/// under the body's rest surface; then the region's area, depths and pressure centre. Cells that
/// are not joined to the region's own contact points belong to a neighbour and count nothing.
void region_grids(StepContext& context);

}  // namespace torsion
