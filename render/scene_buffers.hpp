#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ecs/frame_world.hpp"
#include "ecs/result.hpp"
#include "render/memory.hpp"
#include "render/overlay_draw_list.hpp"

namespace torsion::engine {

/// What changes every frame, once for each frame in flight.
struct SlotBuffers {
  FrameBuffer displacement;      // column VertexDisplacement
  FrameBuffer twist;             // column TwistAngle: only the blocks in use are written
  FrameBuffer axes;              // column TwistAxis
  FrameBuffer uniforms;          // one shared::FrameUniforms
  FrameBuffer contacts;          // rows shared::ContactSpot
  FrameBuffer arrow_positions;   // rows vec4
  FrameBuffer arrow_normals;     // rows vec4
  FrameBuffer arrow_colors;      // rows vec4
  FrameBuffer overlay_vertices;  // rows OverlayVertex
  FrameBuffer overlay_indices;   // uint32

  vk::raii::BufferView displacement_texels = nullptr;
};

/// Everything of a frame world that the device reads or writes. Columns keep their rows.
struct SceneBuffers {
  // constant
  Buffer rest;            // VertexRest of the bodies
  Buffer rest_normals;    // VertexNormal of the bodies
  Buffer body_indices;    // Triangle of the bodies
  Buffer ring_ranges;     // NormalRings::ranges
  Buffer ring_entries;    // NormalRings::entries
  Buffer tool_positions;  // VertexRest of the tools
  Buffer tool_normals;    // VertexNormal of the tools
  Buffer paint;           // VertexPaint of the bodies
  Buffer tool_paint;      // VertexPaint of the tools
  Buffer tool_indices;    // Triangle of the tools
  // written by the compute passes
  Buffer positions;  // vec4 for each vertex of the bodies: m, body; w what the heat map shows
  Buffer normals;    // vec4 for each vertex of the bodies: body, unit
  std::vector<SlotBuffers> slots;

  // The same rows as texels, all of them where has_texels, else as many as the device takes.
  vk::raii::BufferView rest_texels = nullptr;
  vk::raii::BufferView position_texels = nullptr;
  vk::raii::BufferView ring_texels = nullptr;
  bool has_texels = false;
};

/// Error: a column is larger than the device lets a shader read at once. Throws vk::SystemError.
Result<SceneBuffers> make_scene_buffers(const Gpu& gpu, const FrameWorld& frame,
                                        std::uint32_t slots);

/// Error: a body's angles in use are more than a shader can read at once.
std::optional<Error> check_columns(const Gpu& gpu, const FrameWorld& frame);

/// Writes the columns that surface_field() wrote. @pre check_columns() found nothing
void write_columns(const FrameWorld& frame, SlotBuffers& slot);

/// A part of a column as it is bound: begins at or before the first row wanted, where the device
/// allows it.
struct BoundRows {
  vk::DeviceSize offset = 0;  // bytes
  vk::DeviceSize size = 0;    // bytes, > 0
  std::uint32_t first = 0;    // the first row wanted, counted from `offset`
};

/// @param row_size  bytes; divides the device's alignment or is a multiple of it
BoundRows bound_rows(const Gpu& gpu, Range rows, std::uint32_t row_size);

/// The blocks of angles that a body uses, as rows of FrameWorld::twist.
Range twist_rows_in_use(const FrameWorld& frame, std::uint32_t body);

}  // namespace torsion::engine
