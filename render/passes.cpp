#include "render/passes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "render/barriers.hpp"
#include "shaders/shared.h"

namespace torsion {
namespace {

using Commands = vk::raii::CommandBuffer;

constexpr auto kDrawStages = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;
constexpr float kOpaqueTool = 1.0F;
constexpr float kClearTool = 0.13F;  // alpha of a tool where one looks straight through it

template <class Constants>
void push_constants(const Commands& commands, const vk::raii::PipelineLayout& layout,
                    vk::ShaderStageFlags stages, const Constants& constants) {
  commands.pushConstants<Constants>(*layout, stages, 0, constants);
}

void push_storage(const Commands& commands, const FrameInputs& inputs,
                  const std::array<vk::DescriptorBufferInfo, kComputeBindings>& buffers) {
  // Bindings follow one another, so one write fills them all.
  const vk::WriteDescriptorSet write{
      .descriptorCount = kComputeBindings,
      .descriptorType = vk::DescriptorType::eStorageBuffer,
      .pBufferInfo = buffers.data(),
  };
  commands.pushDescriptorSetKHR(vk::PipelineBindPoint::eCompute, *inputs.pipelines.compute_layout,
                                0, write);
}

vk::DescriptorBufferInfo whole(vk::Buffer buffer) {
  return {buffer, 0, VK_WHOLE_SIZE};
}

void dispatch_rows(const Commands& commands, std::uint32_t rows) {
  commands.dispatch((rows + shared::kGroupSize - 1) / shared::kGroupSize, 1, 1);
}

/// Uniforms, shadow map, colour maps, contacts, glyphs: what there is of them.
void push_draw_bindings(const Commands& commands, const FrameInputs& inputs, bool with_shadow_map) {
  const vk::DescriptorBufferInfo uniforms = whole(inputs.slot.uniforms.handle());
  const vk::DescriptorBufferInfo contacts = whole(inputs.slot.contacts.handle());
  const auto sampled = [](const vk::raii::Sampler& sampler, const Image2d& image) {
    return vk::DescriptorImageInfo{*sampler, *image.view, vk::ImageLayout::eShaderReadOnlyOptimal};
  };
  const Surfaces& surfaces = inputs.surfaces;
  const std::array images = {sampled(surfaces.shadow_sampler, surfaces.shadow_map),
                             sampled(surfaces.linear_sampler, surfaces.color_maps),
                             sampled(surfaces.linear_sampler, surfaces.glyphs)};
  std::vector<vk::WriteDescriptorSet> writes;
  const auto add_buffer = [&](std::uint32_t binding, vk::DescriptorType type,
                              const vk::DescriptorBufferInfo& info) {
    writes.push_back({.dstBinding = binding,
                      .descriptorCount = 1,
                      .descriptorType = type,
                      .pBufferInfo = &info});
  };
  const auto add_image = [&](std::uint32_t binding, const vk::DescriptorImageInfo& info) {
    writes.push_back({.dstBinding = binding,
                      .descriptorCount = 1,
                      .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                      .pImageInfo = &info});
  };
  add_buffer(draw_binding::kUniforms, vk::DescriptorType::eUniformBuffer, uniforms);
  add_buffer(draw_binding::kContacts, vk::DescriptorType::eStorageBuffer, contacts);
  if (with_shadow_map) {
    add_image(draw_binding::kShadowMap, images[0]);
    add_image(draw_binding::kColorMaps, images[1]);
    if (*surfaces.glyphs.view) {
      add_image(draw_binding::kGlyphs, images[2]);
    }
  }
  commands.pushDescriptorSetKHR(vk::PipelineBindPoint::eGraphics, *inputs.pipelines.draw_layout, 0,
                                writes);
}

void bind(const Commands& commands, const vk::raii::Pipeline& pipeline) {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
}

void bind_vertices(const Commands& commands, std::initializer_list<vk::Buffer> buffers) {
  const std::vector<vk::DeviceSize> offsets(buffers.size(), 0);
  commands.bindVertexBuffers(0, vk::ArrayProxy<const vk::Buffer>(buffers), offsets);
}

void draw_range(const Commands& commands, const DrawRange& drawn) {
  commands.drawIndexed(3 * drawn.triangles.count, 1, 3 * drawn.triangles.first,
                       static_cast<std::int32_t>(drawn.vertices.first), 0);
}

/// Placement and colour of each row of `things`, then `f(row, constants)` may add to it before the
/// draw.
template <class Things, class F>
void draw_each(const Commands& commands, const FrameInputs& inputs, const Things& things, F&& f) {
  for (std::uint32_t row = 0; row < things.size(); ++row) {
    const auto& drawn = things.template at<DrawRange>(row);
    if (drawn.triangles.count == 0) {
      continue;
    }
    shared::DrawConstants constants{};
    set_pose(things.template at<Pose>(row), constants);
    constants.color = drawn.color;
    f(row, constants);
    push_constants(commands, inputs.pipelines.draw_layout, kDrawStages, constants);
    draw_range(commands, drawn);
  }
}

void set_view(const Commands& commands, const vk::Rect2D& part) {
  commands.setViewport(
      0, vk::Viewport{static_cast<float>(part.offset.x), static_cast<float>(part.offset.y),
                      static_cast<float>(part.extent.width), static_cast<float>(part.extent.height),
                      0.0F, 1.0F});
  commands.setScissor(0, part);
}

void draw_bodies(const Commands& commands, const FrameInputs& inputs) {
  if (inputs.frame.bodies.empty()) {
    return;
  }
  bind(commands, inputs.pipelines.body);
  const SceneBuffers& buffers = inputs.buffers;
  bind_vertices(commands,
                {*buffers.positions.handle, *buffers.normals.handle, *buffers.rest.handle});
  commands.bindIndexBuffer(*buffers.body_indices.handle, 0, vk::IndexType::eUint32);
  draw_each(commands, inputs, inputs.frame.bodies,
            [&](std::uint32_t row, shared::DrawConstants& constants) {
              constants.grid = inputs.extent.grids[row];
              if (!inputs.options.grid) {
                constants.grid.w = 0.0F;
              }
              const Range spots = inputs.contacts[row];
              constants.rows = {spots.first, spots.count,
                                static_cast<std::uint32_t>(inputs.options.heat_map), 0U};
            });
}

void draw_tools(const Commands& commands, const FrameInputs& inputs) {
  if (inputs.frame.tools.empty()) {
    return;
  }
  bind_vertices(commands,
                {*inputs.buffers.tool_positions.handle, *inputs.buffers.tool_normals.handle});
  commands.bindIndexBuffer(*inputs.buffers.tool_indices.handle, 0, vk::IndexType::eUint32);
  for (const vk::raii::Pipeline* pipeline :
       {&inputs.pipelines.tool_depth, &inputs.pipelines.tool}) {
    bind(commands, *pipeline);
    draw_each(commands, inputs, inputs.frame.tools,
              [&](std::uint32_t row, shared::DrawConstants& constants) {
                constants.color.w *= inputs.options.transparent_tools ? kClearTool : kOpaqueTool;
                constants.grid = inputs.extent.tool_centers[row];
              });
  }
}

void draw_arrows(const Commands& commands, const FrameInputs& inputs) {
  if (inputs.arrow_vertices == 0) {
    return;
  }
  bind(commands, inputs.pipelines.arrow);
  const SlotBuffers& slot = inputs.slot;
  bind_vertices(commands, {slot.arrow_positions.handle(), slot.arrow_normals.handle(),
                           slot.arrow_colors.handle()});
  commands.draw(inputs.arrow_vertices, 1, 0, 0);
}

/// The part of a clip that is on the target.
vk::Rect2D clip_rectangle(const OverlayClip& clip, vk::Extent2D extent) {
  const auto inside = [](std::int64_t value, std::uint32_t size) {
    return std::clamp<std::int64_t>(value, 0, size);
  };
  const std::int64_t left = inside(clip.left, extent.width);
  const std::int64_t top = inside(clip.top, extent.height);
  const std::int64_t right = inside(std::int64_t{clip.left} + clip.width, extent.width);
  const std::int64_t bottom = inside(std::int64_t{clip.top} + clip.height, extent.height);
  return {{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)},
          {static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top)}};
}

/// @param clips  which of the overlay's; one without clips is drawn whole
void draw_overlay(const Commands& commands, const FrameInputs& inputs, vk::Extent2D extent,
                  const vk::raii::Pipeline& pipeline, std::span<const OverlayClip> clips) {
  if (inputs.overlay == nullptr || inputs.overlay->indices.empty() ||
      !*inputs.surfaces.glyphs.view) {
    return;
  }
  bind(commands, pipeline);
  bind_vertices(commands, {inputs.slot.overlay_vertices.handle()});
  commands.bindIndexBuffer(inputs.slot.overlay_indices.handle(), 0, vk::IndexType::eUint32);
  shared::OverlayConstants constants{};
  constants.pixel_to_clip.x = 2.0F / static_cast<float>(extent.width);
  constants.pixel_to_clip.y = 2.0F / static_cast<float>(extent.height);
  push_constants(commands, inputs.pipelines.draw_layout, kDrawStages, constants);
  if (inputs.overlay->clips.empty()) {
    commands.drawIndexed(static_cast<std::uint32_t>(inputs.overlay->indices.size()), 1, 0, 0, 0);
  }
  for (const OverlayClip& clip : clips) {
    const vk::Rect2D rectangle = clip_rectangle(clip, extent);
    if (rectangle.extent.width > 0 && rectangle.extent.height > 0) {
      commands.setScissor(0, rectangle);
      commands.drawIndexed(clip.count, 1, clip.first, 0, 0);
    }
  }
}

vk::RenderingAttachmentInfo color_attachment(const Frame& target, const Surfaces& surfaces,
                                             const shared::vec4& background) {
  vk::RenderingAttachmentInfo color{
      .imageView = target.view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearValue(vk::ClearColorValue(
          std::array<float, 4>{background.x, background.y, background.z, background.w})),
  };
  if (*surfaces.color.view) {
    color.imageView = *surfaces.color.view;
    color.resolveMode = vk::ResolveModeFlagBits::eAverage;
    color.resolveImageView = target.view;
    color.resolveImageLayout = vk::ImageLayout::eColorAttachmentOptimal;
    color.storeOp = vk::AttachmentStoreOp::eDontCare;
  }
  return color;
}

vk::RenderingAttachmentInfo depth_attachment(const Image2d& image, vk::AttachmentStoreOp store) {
  return {
      .imageView = *image.view,
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = store,
      .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{1.0F, 0}),
  };
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
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *inputs.pipelines.deform);
  const FrameWorld& frame = inputs.frame;
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
    if (vertices.count == 0) {
      continue;
    }
    const auto& row = frame.bodies.at<FrameBody>(body);
    const BoundRows twist =
        bound_rows(inputs.gpu, twist_rows_in_use(frame, body), sizeof(TwistAngle));
    push_storage(commands, inputs,
                 {whole(*inputs.buffers.rest.handle), whole(inputs.slot.displacement.handle()),
                  vk::DescriptorBufferInfo{inputs.slot.twist.handle(), twist.offset, twist.size},
                  whole(inputs.slot.axes.handle()), whole(*inputs.buffers.positions.handle)});
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
  push_storage(commands, inputs,
               {whole(*buffers.positions.handle), whole(*buffers.ring_ranges.handle),
                whole(*buffers.ring_entries.handle), whole(*buffers.rest_normals.handle),
                whole(*buffers.normals.handle)});
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

void record_shadow(const Commands& commands, const FrameInputs& inputs) {
  const Image2d& map = inputs.surfaces.shadow_map;
  sampled_to_shadow_target(commands, *map.handle);
  const vk::RenderingAttachmentInfo depth = depth_attachment(map, vk::AttachmentStoreOp::eStore);
  commands.beginRendering(vk::RenderingInfo{
      .renderArea = {{0, 0}, map.extent}, .layerCount = 1, .pDepthAttachment = &depth});
  bind(commands, inputs.pipelines.shadow);
  push_draw_bindings(commands, inputs, false);
  const auto as_it_is = [](std::uint32_t /*row*/, shared::DrawConstants& /*constants*/) {
  };
  // Bodies left, tools right: light.glsl says why.
  const std::uint32_t side = map.extent.height;
  if (!inputs.frame.bodies.empty()) {
    set_view(commands, {{0, 0}, {side, side}});
    bind_vertices(commands, {*inputs.buffers.positions.handle});
    commands.bindIndexBuffer(*inputs.buffers.body_indices.handle, 0, vk::IndexType::eUint32);
    draw_each(commands, inputs, inputs.frame.bodies, as_it_is);
  }
  if (!inputs.frame.tools.empty()) {
    set_view(commands, {{static_cast<std::int32_t>(side), 0}, {side, side}});
    bind_vertices(commands, {*inputs.buffers.tool_positions.handle});
    commands.bindIndexBuffer(*inputs.buffers.tool_indices.handle, 0, vk::IndexType::eUint32);
    draw_each(commands, inputs, inputs.frame.tools, as_it_is);
  }
  commands.endRendering();
  shadow_target_to_sampled(commands, *map.handle);
}

void record_draw(const Frame& target, const FrameInputs& inputs) {
  const Commands& commands = *target.commands;
  const Surfaces& surfaces = inputs.surfaces;
  to_color_target(commands, target.image);
  if (*surfaces.color.handle) {
    to_color_target(commands, *surfaces.color.handle);
  }
  to_depth_target(commands, *surfaces.depth.handle);
  const vk::RenderingAttachmentInfo color = color_attachment(target, surfaces, inputs.background);
  const vk::RenderingAttachmentInfo depth =
      depth_attachment(surfaces.depth, vk::AttachmentStoreOp::eDontCare);
  commands.beginRendering(vk::RenderingInfo{
      .renderArea = inputs.part,
      .layerCount = 1,
      .colorAttachmentCount = 1,
      .pColorAttachments = &color,
      .pDepthAttachment = &depth,
  });
  set_view(commands, {{0, 0}, target.extent});
  commands.setScissor(0, inputs.part);
  push_draw_bindings(commands, inputs, true);
  draw_bodies(commands, inputs);
  draw_arrows(commands, inputs);
  if (inputs.options.ground) {
    bind(commands, inputs.pipelines.ground);
    commands.draw(6, 1, 0, 0);
  }
  draw_tools(commands, inputs);
  if (!inputs.overlay_apart) {
    const std::span<const OverlayClip> all = inputs.overlay == nullptr
                                                 ? std::span<const OverlayClip>{}
                                                 : std::span(inputs.overlay->clips);
    draw_overlay(commands, inputs, target.extent, inputs.pipelines.overlay, all);
  }
  commands.endRendering();
}

void record_overlay(const Commands& commands, vk::ImageView view, vk::Extent2D extent,
                    const vk::raii::Pipeline& pipeline, const FrameInputs& inputs,
                    OverlayPart part) {
  if (inputs.overlay == nullptr) {
    return;
  }
  const std::span<const OverlayClip> clips(inputs.overlay->clips);
  const std::size_t marks = clips.size() - inputs.overlay->panel_clips;
  const bool panels = part == OverlayPart::kPanels;
  const auto drawn = panels ? clips.subspan(marks) : clips.first(marks);
  if (drawn.empty()) {
    return;
  }
  const vk::RenderingAttachmentInfo color{
      .imageView = view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = panels ? vk::AttachmentLoadOp::eDontCare : vk::AttachmentLoadOp::eLoad,
      .storeOp = vk::AttachmentStoreOp::eStore,
  };
  commands.beginRendering(vk::RenderingInfo{
      .renderArea = {{0, 0}, extent},
      .layerCount = 1,
      .colorAttachmentCount = 1,
      .pColorAttachments = &color,
  });
  set_view(commands, {{0, 0}, extent});
  push_draw_bindings(commands, inputs, true);
  draw_overlay(commands, inputs, extent, pipeline, drawn);
  commands.endRendering();
}

}  // namespace torsion
