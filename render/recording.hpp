#pragma once

// What the passes record with.

#include <initializer_list>

#include "render/passes.hpp"
#include "shaders/shared.h"

namespace torsion::engine {

inline constexpr auto kDrawStages =
    vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

template <class Constants>
void push_constants(const vk::raii::CommandBuffer& commands, const vk::raii::PipelineLayout& layout,
                    vk::ShaderStageFlags stages, const Constants& constants) {
  commands.pushConstants<Constants>(*layout, stages, 0, constants);
}

inline vk::DescriptorBufferInfo whole(vk::Buffer buffer) {
  return {buffer, 0, VK_WHOLE_SIZE};
}

/// Uniforms, shadow map, colour maps, contacts, glyphs: what there is of them.
void push_draw_bindings(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs,
                        bool with_shadow_map);

/// The textures of a material.
void push_textures(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs,
                   std::uint32_t material);

void bind(const vk::raii::CommandBuffer& commands, const vk::raii::Pipeline& pipeline);

/// From their beginnings, binding i for the i-th.
void bind_vertices(const vk::raii::CommandBuffer& commands,
                   std::initializer_list<vk::Buffer> buffers);

/// Viewport and scissor.
void set_view(const vk::raii::CommandBuffer& commands, const vk::Rect2D& part);

/// The overlay within a rendering pass.
/// @param clips  which of the overlay's; one without clips is drawn whole
void draw_overlay(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs,
                  vk::Extent2D extent, const vk::raii::Pipeline& pipeline,
                  std::span<const OverlayClip> clips);

}  // namespace torsion::engine
