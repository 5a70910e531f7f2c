#include <array>
#include <cstddef>

#include "render/barriers.hpp"
#include "render/recording.hpp"

namespace torsion::engine {
namespace {

using Commands = vk::raii::CommandBuffer;

constexpr float kOpaqueTool = 1.0F;
constexpr float kClearTool = 0.13F;  // alpha of a tool where one looks straight through it

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

}  // namespace torsion::engine
