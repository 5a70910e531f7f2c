#include <algorithm>
#include <array>

#include "render/barriers.hpp"
#include "render/recording.hpp"

namespace torsion::engine {
namespace {

using Commands = vk::raii::CommandBuffer;

void push_rows(const Commands& commands, const FrameInputs& inputs,
               const std::array<vk::DescriptorBufferInfo, kStorageBindings>& buffers,
               const std::array<vk::BufferView, kTexelBindings>& texels) {
  // Bindings of a kind follow one another, so one write fills them all.
  const std::array<vk::WriteDescriptorSet, 2> writes = {{
      {.dstBinding = 0,
       .descriptorCount = kStorageBindings,
       .descriptorType = vk::DescriptorType::eStorageBuffer,
       .pBufferInfo = buffers.data()},
      {.dstBinding = kStorageBindings,
       .descriptorCount = kTexelBindings,
       .descriptorType = vk::DescriptorType::eUniformTexelBuffer,
       .pTexelBufferView = texels.data()},
  }};
  commands.pushDescriptorSetKHR(vk::PipelineBindPoint::eCompute, *inputs.pipelines.compute_layout,
                                0, writes);
}

void dispatch_rows(const Commands& commands, std::uint32_t rows) {
  commands.dispatch((rows + shared::kGroupSize - 1) / shared::kGroupSize, 1, 1);
}

}  // namespace

void record_uploads(const Commands& commands, SlotBuffers& slot) {
  bool copied = false;
  for (FrameBuffer* buffer : {&slot.displacement, &slot.twist, &slot.axes, &slot.uniforms,
                              &slot.contacts, &slot.arrow_positions, &slot.arrow_normals,
                              &slot.arrow_colors, &slot.overlay_vertices, &slot.overlay_indices}) {
    copied = buffer->record_copies(commands) || copied;
  }
  if (copied) {
    copies_to_frame(commands);
  }
}

void record_deform(const Commands& commands, const FrameInputs& inputs) {
  last_frame_to_compute(commands);
  const FrameWorld& frame = inputs.frame;
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
    if (vertices.count == 0) {
      continue;
    }
    const auto& row = frame.bodies.at<FrameBody>(body);
    const BoundRows twist =
        bound_rows(inputs.gpu, twist_rows_in_use(frame, body), sizeof(TwistAngle));
    const std::uint32_t regions = std::min(row.regions_drawn, shared::kManyRegions);
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *inputs.pipelines.deform[regions]);
    push_rows(commands, inputs,
              {whole(*inputs.buffers.rest.handle), whole(inputs.slot.displacement.handle()),
               vk::DescriptorBufferInfo{inputs.slot.twist.handle(), twist.offset, twist.size},
               whole(inputs.slot.axes.handle()), whole(*inputs.buffers.positions.handle)},
              {*inputs.buffers.rest_texels, *inputs.slot.displacement_texels});
    push_constants(commands, inputs.pipelines.compute_layout, vk::ShaderStageFlagBits::eCompute,
                   shared::DeformConstants{
                       .vertex_first = vertices.first,
                       .vertex_count = vertices.count,
                       .twist_first = twist.first,
                       .axis_first = row.axes.first,
                       .regions = row.regions_drawn,
                       .heat = static_cast<std::uint32_t>(inputs.options.heat_map),
                   });
    dispatch_rows(commands, vertices.count);
  }
}

void record_normals(const Commands& commands, const FrameInputs& inputs) {
  compute_to_compute(commands);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *inputs.pipelines.normals);
  const SceneBuffers& buffers = inputs.buffers;
  push_rows(commands, inputs,
            {whole(*buffers.positions.handle), whole(*buffers.ring_ranges.handle),
             whole(*buffers.ring_entries.handle), whole(*buffers.rest_normals.handle),
             whole(*buffers.normals.handle)},
            {*buffers.position_texels, *buffers.ring_texels});
  for (std::uint32_t body = 0; body < inputs.frame.bodies.size(); ++body) {
    const Range vertices = inputs.frame.bodies.at<DrawRange>(body).vertices;
    if (vertices.count == 0) {
      continue;
    }
    push_constants(commands, inputs.pipelines.compute_layout, vk::ShaderStageFlagBits::eCompute,
                   shared::NormalConstants{vertices.first, vertices.count});
    dispatch_rows(commands, vertices.count);
  }
  compute_to_vertices(commands);
}

}  // namespace torsion::engine
