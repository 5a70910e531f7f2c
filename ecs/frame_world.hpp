#pragma once

#include <vector>

#include "ecs/components.hpp"
#include "ecs/draw_material.hpp"
#include "ecs/table.hpp"

namespace torsion::engine {

/// Row i of an anchor interpolation: how the anchors' displacements become those of any point
/// (docs/models.md).
struct InterpolationRow {
  double value = 0.0;
};

/// What the frame needs of a body besides its vertices. Written by: load.
struct FrameBody {
  Range anchors;        // in Snapshot::anchors and FrameWorld::anchor_rest
  Range held_points;    // in FrameWorld::anchor_rest: points of the fixed region that stay put
  Range interpolation;  // in `interpolation`: n^2 values, row-major, n = anchors + held_points + 4;
                        // empty without anchors
  Range twist;          // in `twist`: kMaxRegionsPerBody blocks of `vertices.count` rows
  Range axes;           // in `axes`: kMaxRegionsPerBody rows
  std::uint32_t regions_drawn =
      0;  // how many slots of `twist` and `axes` hold something. Written by: surface_field
  std::uint32_t padding = 0;
};

/// The frame world: per-vertex columns, laid out as the GPU reads them. Nothing of it is read by a
/// physics step.
struct FrameWorld {
  Table<Pose, DrawRange, FrameBody> bodies;  // row = row of Model::bodies
  Table<Pose, DrawRange> tools;  // row = row of Model::tools; pose written by surface_field
  Table<VertexRest, VertexNormal, VertexPaint, VertexDisplacement> body_vertices;
  Table<TwistAngle> twist;
  Table<TwistAxis> axes;
  Table<Triangle> body_triangles;
  Table<DrawGroup> body_groups;
  Table<VertexRest, VertexNormal, VertexPaint> tool_vertices;  // tool frame
  Table<Triangle> tool_triangles;
  Table<DrawGroup> tool_groups;
  std::vector<DrawMaterial> materials;
  Table<AnchorRest> anchor_rest;
  Table<InterpolationRow> interpolation;
};

}  // namespace torsion::engine
