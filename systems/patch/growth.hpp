#pragma once

// Grids that a contact outgrows faster than regridding around its loaded cells follows: those reach
// the grid's edge then, and do not tell how far the contact goes on.

#include <cstdint>

#include <glm/vec2.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// By what factor a grid must grow along each of its axes to hold what it cuts off, from the depths
/// at its edges, as if depth fell with the square of the distance; 1 along an axis on which it cuts
/// off nothing, or little.
/// @param cells  those that count
/// @param little  depth at an edge over the largest: what is less deep is left to the next pass
glm::dvec2 growth_at_edges(const Grid& grid, const CellBits& cells, double little);

/// Widens a box along the axes on which a grid cuts off a contact, by the overlap on a grid that is
/// larger by `growth`. The grid stays, its cells look for the tool anew.
/// @param depth  m, from which cells look for the tool
/// @param box    m, from the grid's origin: of the loaded cells
void include_overlap(const Grid& grid, const RegionPoints& contact, const glm::dvec2& growth,
                     double depth, PlaneBox& box);

/// By what factor the tool's motion of this step deepens a contact, at its centre; at least 1.
double deepening(const State& state, std::uint32_t region);

/// Lays a larger grid in a step in which the contact gets so much deeper that it outgrows the one
/// that it has: as far as the overlap grows with the depth, and no farther than that. Pressures
/// grow alike. Of the force's change nothing is faded: it is the motion's.
void grow_with_depth(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Whether a region's grid grew so, and the contact did not outgrow it any more in the last step.
/// How large the contact is shows only then: it is laid around the loaded cells.
bool has_grown(const PatchState& state);

}  // namespace torsion::engine
