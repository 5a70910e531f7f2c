#pragma once

#include <glm/vec3.hpp>

#include "systems/contact/grid_cells.hpp"

namespace torsion::engine {

/// The normal of the face of the grid's body that its tool presses on at a contact point. Where
/// faces meet, a point inside is as near to one as to the other, and the nearest says nothing: the
/// tool leaves by the face under which it reaches less deep at their edge, as the way out is the
/// shortest there.
/// @param point  of the tool's surface, inside the body
/// @return body frame, unit, outwards
glm::dvec3 pressed_normal(const Grid& grid, const ContactPoint& point);

}  // namespace torsion::engine
