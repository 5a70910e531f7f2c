#pragma once

#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion {

// The grids of regions with contact model `patch`. Their cells stay where they are on the body as
// long as they can: displacements belong to places on the body, and every move of the grid that is
// not by whole cells smooths them.

/// True when the region's body has contact model `patch`.
bool has_patch(const World& world, const RegionIdentity& region);

/// Half the sides, at least `least`, of a grid whose cells have one of the shapes that there are
/// influence tables for.
/// @param least  m
glm::dvec2 patch_half_size(const glm::dvec2& least);

/// Likewise, of cells with a given shape: 2^aspect times as long along x as along y.
glm::dvec2 patch_half_size(const glm::dvec2& least, std::int32_t aspect);

/// Where a contact's middle is laid in a grid, in cells from its corner: in the middle of a column
/// and between two rows. Each axis
/// alone is mirror-symmetric, but the two staircases of the contact's rim differ: where they are
/// the same their errors add up, to three times as much in the torque.
glm::dvec2 patch_middle(std::uint32_t side);

/// Columns at the grid's left that stay empty for that, so that as many are on either side of the
/// middle: 1, or 0 where the grid is too coarse to spare one or odd already.
std::uint32_t patch_spare(std::uint32_t side);

/// Which of those shapes a grid has: -kMostAspect to kMostAspect.
std::int32_t patch_aspect(const glm::dvec2& half_size);

/// Moves a region's grid by whole cells, or lays it anew, when the cells that carry pressure come
/// to its edge, leave much of it empty, or when a point of the contact lies outside that the
/// pressure cannot keep away. What the cells hold goes with their places.
void follow_patch(StepContext& context, std::uint32_t region, const RegionPoints& contact);

}  // namespace torsion
