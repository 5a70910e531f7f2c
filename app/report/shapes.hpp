#pragma once

#include <cstdint>

#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// A closed surface of one of the exact shapes, cut like a cube of `cuts` x `cuts` quads a face,
/// outward.
/// @param half_extent  m
/// @param cuts  odd, so that no vertex lies where a capsule's caps meet its cylinder
SurfaceMesh shape_surface(ShapeKind kind, const glm::dvec3& half_extent, std::uint32_t cuts);

/// The exact shape as a part of a tool or body.
PartDescription exact_part(ShapeKind kind, const glm::dvec3& half_extent, const Pose& pose = {},
                           std::uint32_t cuts = 25);

/// A drawn mesh of these surfaces with a vertex for every corner of every triangle.
/// @param smooth  false: each face has its own normal
DrawMesh drawn(const std::vector<SurfaceMesh>& surfaces, bool smooth, const glm::vec4& color);

}  // namespace torsion::engine
