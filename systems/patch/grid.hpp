#pragma once

#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion {

// The grids of regions with contact model `patch`. Their cells stay where they are on the body as
// long as they can: displacements belong to places on the body, and every move of the grid that is
// not by whole cells smooths them.

/// Where a contact's middle is laid in a grid, in cells from its corner: in the middle of a column
/// and between two rows. Each axis
/// alone is mirror-symmetric, but the two staircases of the contact's rim differ: where they are
/// the same their errors add up, to three times as much in the torque.
glm::dvec2 patch_middle(std::uint32_t side);

/// Columns at the grid's left that stay empty for that, so that as many are on either side of the
/// middle: 1, or 0 where the grid is too coarse to spare one or odd already.
std::uint32_t patch_spare(std::uint32_t side);

/// ContactLaw::follow. Moves a region's grid by whole cells, or lays it anew, when the cells that
/// carry pressure come to its edge, leave much of it empty, or when a point of the contact lies
/// outside that the pressure cannot keep away. What the cells hold goes with their places. A region
/// without force begins anew.
void follow_patch(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// ContactLaw::find_cells. The grid of a new region is found by its overlap; later on what sticks
/// is seen where it will have gone with the tool.
void find_patch_cells(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Lays a region's grid around its loaded cells at once.
void lay_around_loaded(StepContext& context, std::uint32_t region, const RegionPoints& contact);

}  // namespace torsion
