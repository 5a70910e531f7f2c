#pragma once

#include <span>

#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// Mass centre and inertia of a solid of even density that fills `parts` (parts that overlap count
/// twice there), by signed tetrahedra to the origin (Tonon, "Explicit exact formulas for the 3-D
/// tetrahedron inertia tensor", 2004).
/// @param mass  kg
MassProperties mass_properties(std::span<const PartDescription> parts, double mass);

/// Moves the mass centre and the inertia with it (parallel axes).
/// @param center  m, tool
void move_mass_center(MassProperties& properties, const glm::dvec3& center);

}  // namespace torsion::engine
