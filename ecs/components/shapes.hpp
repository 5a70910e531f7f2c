#pragma once

// The solids of tools and bodies: parts, distance fields, and the samples of a tool's surface.
// Units, frames and "written by": ecs/components.hpp.

#include <cstdint>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/components/basics.hpp"
#include "ecs/range.hpp"

namespace torsion::engine {

enum class ShapeKind : std::uint32_t { kSphere, kEllipsoid, kBox, kCylinder, kCapsule, kMesh };

/// One closed solid of a tool or body; a tool or body is the union of its parts. Written by: load.
/// Cylinder and capsule have their axis along y; a capsule's half_extent.y includes its caps.
struct ShapePart {
  Pose pose;                    // part frame in the owner's frame (tool or body)
  glm::dvec3 half_extent{0.0};  // m, part frame; a sphere uses .x
  ShapeKind kind = ShapeKind::kSphere;
  std::uint32_t field = kNoRow;  // row in `fields` when kind is kMesh
};

/// A two-level grid of signed distances to a closed mesh: coarse nodes everywhere, bricks of fine
/// nodes near the surface (systems/geometry/distance_field.hpp says how it is read). Written by:
/// load.
struct DistanceField {
  glm::dvec3 origin{0.0};         // m, part frame, the lowest node
  double spacing = 0.0;           // m, between coarse nodes
  glm::uvec3 cells{0};            // coarse cells along each axis; nodes are one more
  std::uint32_t subdivision = 1;  // fine cells along one edge of a coarse cell
  Range coarse_nodes;             // rows in `field_nodes`, x fastest; the field's others follow
  Range bricks;                   // rows in `field_bricks`, one for each coarse cell, x fastest
  Range creases;                  // rows in `field_creases`
};

/// Gradient and signed distance at one grid node (negative inside). Written by: load.
struct DistanceNode {
  glm::vec4 gradient_and_distance{0.0F};  // xyz: unitless, part frame; w: m
};

/// The fine grid in one coarse cell, where it has one. Its rows are relative to the field's first
/// node and first crease. Written by: load.
struct DistanceBrick {
  std::uint32_t first_node = kNoRow;    // of (subdivision + 1)^3, or kNoRow
  std::uint32_t first_crease = kNoRow;  // of subdivision^3, x fastest, or kNoRow where the surface
                                        // is smooth in all its cells
};

/// The planes whose edges cut a fine cell. Its rows are relative to the field's first node. Written
/// by: load.
struct DistanceCrease {
  std::uint32_t first_plane = kNoRow;  // a node that holds a plane's normal, and the distance of
                                       // the cell's lowest corner from it
  std::uint16_t planes = 0;            // how many; 0 where the surface is smooth
  std::uint16_t concave = 0;           // 1 where the innermost counts, 0 where the outermost does
};

/// A node of the sphere tree over a tool's surface: everything of the surface below it lies in this
/// ball. Written by: load.
struct SurfaceBall {
  glm::dvec3 center{0.0};  // m, tool frame
  double radius = 0.0;     // m
  std::uint32_t skip =
      0;  // row, relative to the tool's first ball, to go to when this ball is far away
  std::uint32_t sample =
      kNoRow;  // row, relative to the tool's first sample, for a leaf; kNoRow inside the tree
};

inline constexpr std::uint32_t kSampleNeighbours = 8;

/// A point of a tool's surface. Its neighbours are rows relative to the tool's first sample.
/// Written by: load.
struct SurfaceSample {
  glm::dvec3 position{0.0};                          // m, tool frame
  double spacing = 0.0;                              // m, to the farthest of its neighbours
  std::uint32_t neighbours[kSampleNeighbours] = {};  // kNoRow where there are fewer
};

}  // namespace torsion::engine
