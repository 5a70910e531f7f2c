#include <algorithm>
#include <cstdint>

#include "render/recording.hpp"

namespace torsion::engine {
namespace {

using Commands = vk::raii::CommandBuffer;

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

}  // namespace

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

}  // namespace torsion::engine
