#pragma once

#include "systems/contact/grid_place.hpp"

namespace torsion {

/// Half sides of a grid, and where its origin goes along its axes, m.
struct GridLayout {
  glm::dvec2 half_size{0.0};
  glm::dvec2 shift{0.0};
};

/// Share of a new grid's side that the loaded cells take up: no more than what leaves a free row on
/// either side, or the next step would lay it anew: of a contact in the middle half a cell more on
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
/// motion, which is told at the origin, is told there from then on.
void shift_origin(const Grid& grid, const glm::dvec2& shift);

}  // namespace torsion
