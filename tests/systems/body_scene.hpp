#pragma once

// One elastic body without any tool, and regions put on it by hand: what the tests of the body
// models need.

#include <cstdint>
#include <vector>

#include "ecs/scene_description.hpp"
#include "ecs/world.hpp"

namespace torsion::engine {

/// A closed mesh of the shape's surface, about `cells` cells along an edge or a quarter turn.
SurfaceMesh shape_surface(ShapeKind kind, const glm::dvec3& half_extent, std::uint32_t cells);

/// A body of one exact shape about the origin of its frame, held at the middle of its lowest point
/// or face.
BodyDescription exact_body(ShapeKind kind, const glm::dvec3& half_extent, FixedKind fixed,
                           std::uint32_t cells = 12);

/// A world with this one body, its anchors and beam sections, room for 16 regions and one tool that
/// is a small sphere far away. `anchors` rows are on the body model skeleton.
World body_world(const BodyDescription& body);

/// What the tests set of one region.
struct RegionOnBody {
  glm::dvec3 point{0.0};             // m, body: where p_eq was on the rest surface
  glm::dvec3 normal{0.0, 1.0, 0.0};  // body, outward
  glm::dvec3 force_on_body{0.0};     // N, body
  double couple_on_body = 0.0;       // N m about the normal
  double radius = 0.005;             // m
  double depth = 0.0;                // m
};

/// Adds a region of tool 0 on body 0; its row.
std::uint32_t add_region(World& world, const RegionOnBody& region);

}  // namespace torsion::engine
