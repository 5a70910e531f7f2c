#pragma once

// Recording of a frame's passes, in their order. Nothing here waits or submits.

#include <cstdint>
#include <optional>
#include <span>

#include "ecs/frame_world.hpp"
#include "render/draw_options.hpp"
#include "render/frame_view.hpp"
#include "render/material_textures.hpp"
#include "render/memory.hpp"
#include "render/overlay_draw_list.hpp"
#include "render/pipelines.hpp"
#include "render/scene_buffers.hpp"
#include "render/surfaces.hpp"
#include "render/target.hpp"

namespace torsion::engine {

/// What a frame is recorded from.
struct FrameInputs {
  const Gpu& gpu;
  const Pipelines& pipelines;
  const SceneBuffers& buffers;
  const Surfaces& surfaces;
  const MaterialTextures& textures;
  const SceneExtent& extent;
  const FrameWorld& frame;
  const DrawOptions& options;
  const SlotBuffers& slot;          // written for this frame
  shared::vec4 background;          // linear rgb, alpha
  std::span<const Range> contacts;  // rows in slot.contacts, one for each body
  std::uint32_t arrow_vertices = 0;
  const OverlayDrawList* overlay = nullptr;
  bool overlay_apart = false;  // it is drawn by record_overlay(), not over the scene's picture
  vk::Rect2D part;             // of the target: what nothing hides; no more than that is drawn
};

/// Records the copies of what the CPU wrote for this frame, where there are staging buffers.
void record_uploads(const vk::raii::CommandBuffer& commands, SlotBuffers& slot);

void record_deform(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs);
void record_normals(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs);
void record_shadow(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs);

/// Ground, bodies and arrows, the tools over them, the overlay over all unless `inputs` has none.
void record_draw(const Frame& target, const FrameInputs& inputs);

enum class OverlayPart : std::uint8_t { kMarks, kPanels };

/// A part of a window's overlay alone: marks over what is on the image, panels into one of theirs,
/// whose format keeps encoded colours as they are: blending them so is what Dear ImGui is made for,
/// and a third of the time on a processor.
/// @param pipeline  for that image's format, one sample a pixel
void record_overlay(const vk::raii::CommandBuffer& commands, vk::ImageView view,
                    vk::Extent2D extent, const vk::raii::Pipeline& pipeline,
                    const FrameInputs& inputs, OverlayPart part);

}  // namespace torsion::engine
