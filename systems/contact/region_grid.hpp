#pragma once

#include <span>

#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion {

/// Lays a new region's grid: in the body's tangent plane at the deepest of the cluster's points,
/// just around them. The axes come from the body frame, so a scene that is turned as a whole gives
/// a grid that is turned with it.
void place_new_grid(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Moves a region's grid along with its contact: centre, size and normal follow what the last
/// step's cells found, and the cluster's points lie on it. The x axis turns with the normal and not
/// about it.
void follow_contact(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Finds, for every cell of every region, the tool's surface along the normal and how deep it is
/// under the body's rest surface; then the region's area, depths and pressure centre. Cells that
/// are not joined to the region's own contact points belong to a neighbour and count nothing.
void region_grids(StepContext& context);

}  // namespace torsion
