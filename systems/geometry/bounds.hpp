#pragma once

// Boxes along the axes around places.

#include <span>

#include <glm/vec3.hpp>

#include "ecs/components/bodies.hpp"
#include "ecs/scene_description.hpp"

namespace torsion {

/// The least box around places, m; of none it is inside out.
Bounds bounds_of(std::span<const glm::dvec3> places);

/// The least box around the surfaces of parts, in their owner's frame.
Bounds bounds_of(std::span<const PartDescription> parts);

/// True where two boxes have a place in common, or are no farther apart than `slack`, m, along each
/// axis.
bool boxes_meet(const Bounds& a, const Bounds& b, double slack);

}  // namespace torsion
