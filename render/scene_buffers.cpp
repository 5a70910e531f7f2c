#include "render/scene_buffers.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "render/normal_rings.hpp"
#include "shaders/shared.h"

namespace torsion::engine {
namespace {

using BufferUsage = vk::BufferUsageFlagBits;

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& rows) {
  return std::as_bytes(std::span(rows));
}

std::optional<Error> check_range(const Gpu& gpu, vk::DeviceSize rows, vk::DeviceSize row_size,
                                 const char* what) {
  if (rows * row_size <= gpu.limits.maxStorageBufferRange) {
    return std::nullopt;
  }
  return Error{"The scene has " + std::to_string(rows) + " " + what + "; the device \"" + gpu.name +
               "\" can draw " + std::to_string(gpu.limits.maxStorageBufferRange / row_size) +
               " at most. Use coarser meshes."};
}

/// The first rows of a column as texels, as many as the device takes.
/// @param row_size  bytes, of the format
vk::raii::BufferView make_texels(const Gpu& gpu, vk::Buffer buffer, vk::DeviceSize size,
                                 vk::Format format, vk::DeviceSize row_size) {
  const vk::DeviceSize most = gpu.limits.maxTexelBufferElements * row_size;
  return {gpu.device, vk::BufferViewCreateInfo{
                          .buffer = buffer, .format = format, .range = std::min(size, most)}};
}

constexpr vk::Format kRowFormat = vk::Format::eR32G32B32A32Sfloat;

SlotBuffers make_slot(const Gpu& gpu, const FrameWorld& frame) {
  const vk::DeviceSize vertices = frame.body_vertices.size();
  const vk::DeviceSize regions = vk::DeviceSize{frame.bodies.size()} * kMaxRegionsPerBody;
  SlotBuffers slot;
  slot.displacement = {gpu, vertices * sizeof(VertexDisplacement),
                       BufferUsage::eStorageBuffer | BufferUsage::eUniformTexelBuffer};
  slot.displacement_texels = make_texels(gpu, slot.displacement.handle(), slot.displacement.size(),
                                         kRowFormat, sizeof(VertexDisplacement));
  slot.twist = {gpu, frame.twist.size() * sizeof(TwistAngle), BufferUsage::eStorageBuffer};
  slot.axes = {gpu, frame.axes.size() * sizeof(TwistAxis), BufferUsage::eStorageBuffer};
  slot.uniforms = {gpu, sizeof(shared::FrameUniforms), BufferUsage::eUniformBuffer};
  slot.contacts = {gpu, regions * sizeof(shared::ContactSpot), BufferUsage::eStorageBuffer};
  slot.arrow_positions = {gpu, 0, BufferUsage::eVertexBuffer};
  slot.arrow_normals = {gpu, 0, BufferUsage::eVertexBuffer};
  slot.arrow_colors = {gpu, 0, BufferUsage::eVertexBuffer};
  slot.overlay_vertices = {gpu, 0, BufferUsage::eVertexBuffer};
  slot.overlay_indices = {gpu, 0, BufferUsage::eIndexBuffer};
  return slot;
}

}  // namespace

Result<SceneBuffers> make_scene_buffers(const Gpu& gpu, const FrameWorld& frame,
                                        std::uint32_t slots) {
  const NormalRings rings = make_normal_rings(frame);
  for (const std::optional<Error>& error : {
           check_range(gpu, frame.body_vertices.size(), sizeof(VertexRest),
                       "vertices of elastic bodies"),
           check_range(gpu, rings.entries.size(), sizeof(std::uint32_t),
                       "edges around vertices of elastic bodies"),
       }) {
    if (error) {
      return *error;
    }
  }
  SceneBuffers buffers;
  const auto vertex_columns = [&](const auto& table, auto usage, Buffer& positions,
                                  Buffer& normals) {
    positions =
        make_constant_buffer(gpu, std::as_bytes(table.template column<VertexRest>()), usage);
    normals =
        make_constant_buffer(gpu, std::as_bytes(table.template column<VertexNormal>()), usage);
  };
  const auto both =
      BufferUsage::eStorageBuffer | BufferUsage::eUniformTexelBuffer | BufferUsage::eVertexBuffer;
  vertex_columns(frame.body_vertices, both, buffers.rest, buffers.rest_normals);
  vertex_columns(frame.tool_vertices, both, buffers.tool_positions, buffers.tool_normals);
  buffers.paint = make_constant_buffer(
      gpu, std::as_bytes(frame.body_vertices.column<VertexPaint>()), BufferUsage::eVertexBuffer);
  buffers.tool_paint = make_constant_buffer(
      gpu, std::as_bytes(frame.tool_vertices.column<VertexPaint>()), BufferUsage::eVertexBuffer);
  buffers.body_indices = make_constant_buffer(
      gpu, std::as_bytes(frame.body_triangles.column<Triangle>()), BufferUsage::eIndexBuffer);
  buffers.tool_indices = make_constant_buffer(
      gpu, std::as_bytes(frame.tool_triangles.column<Triangle>()), BufferUsage::eIndexBuffer);
  buffers.ring_ranges =
      make_constant_buffer(gpu, bytes_of(rings.ranges), BufferUsage::eStorageBuffer);
  buffers.ring_entries = make_constant_buffer(
      gpu, bytes_of(rings.entries), BufferUsage::eStorageBuffer | BufferUsage::eUniformTexelBuffer);

  const vk::DeviceSize rows = vk::DeviceSize{frame.body_vertices.size()} * sizeof(shared::vec4);
  const auto computed = both | BufferUsage::eTransferSrc;
  buffers.positions = make_buffer(gpu, rows, computed, Home::kDevice);
  buffers.normals = make_buffer(gpu, rows, computed, Home::kDevice);
  const auto texels = [&](const Buffer& buffer, vk::Format format, vk::DeviceSize row_size) {
    return make_texels(gpu, *buffer.handle, buffer.size, format, row_size);
  };
  buffers.rest_texels = texels(buffers.rest, kRowFormat, sizeof(VertexRest));
  buffers.position_texels = texels(buffers.positions, kRowFormat, sizeof(shared::vec4));
  buffers.ring_texels = texels(buffers.ring_entries, vk::Format::eR32Uint, sizeof(std::uint32_t));
  buffers.has_texels = std::max<std::size_t>(frame.body_vertices.size(), rings.entries.size()) <=
                       gpu.limits.maxTexelBufferElements;
  for (std::uint32_t i = 0; i < slots; ++i) {
    buffers.slots.push_back(make_slot(gpu, frame));
  }
  return buffers;
}

std::optional<Error> check_columns(const Gpu& gpu, const FrameWorld& frame) {
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range rows = twist_rows_in_use(frame, body);
    if (auto error = check_range(gpu, rows.count, sizeof(TwistAngle), "twist angles on one body")) {
      return error;
    }
  }
  return std::nullopt;
}

void write_columns(const FrameWorld& frame, SlotBuffers& slot) {
  slot.displacement.write(0, std::as_bytes(frame.body_vertices.column<VertexDisplacement>()));
  slot.axes.write(0, std::as_bytes(frame.axes.column<TwistAxis>()));
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range rows = twist_rows_in_use(frame, body);
    slot.twist.write(rows.first * sizeof(TwistAngle),
                     std::as_bytes(frame.twist.rows<TwistAngle>(rows)));
  }
}

BoundRows bound_rows(const Gpu& gpu, Range rows, std::uint32_t row_size) {
  const vk::DeviceSize wanted = vk::DeviceSize{rows.first} * row_size;
  const vk::DeviceSize alignment = gpu.limits.minStorageBufferOffsetAlignment;
  BoundRows bound;
  bound.offset = wanted / alignment * alignment;
  bound.first = static_cast<std::uint32_t>((wanted - bound.offset) / row_size);
  bound.size = std::max<vk::DeviceSize>(
      wanted - bound.offset + vk::DeviceSize{rows.count} * row_size, row_size);
  return bound;
}

Range twist_rows_in_use(const FrameWorld& frame, std::uint32_t body) {
  const auto& row = frame.bodies.at<FrameBody>(body);
  return {row.twist.first, row.regions_drawn * frame.bodies.at<DrawRange>(body).vertices.count};
}

}  // namespace torsion::engine
