#include "render/recording.hpp"

#include <array>
#include <vector>

namespace torsion::engine {

void push_draw_bindings(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs,
                        bool with_shadow_map) {
  const vk::DescriptorBufferInfo uniforms = whole(inputs.slot.uniforms.handle());
  const vk::DescriptorBufferInfo contacts = whole(inputs.slot.contacts.handle());
  const auto sampled = [](const vk::raii::Sampler& sampler, const Image2d& image) {
    return vk::DescriptorImageInfo{*sampler, *image.view, vk::ImageLayout::eShaderReadOnlyOptimal};
  };
  const Surfaces& surfaces = inputs.surfaces;
  const std::array images = {sampled(surfaces.shadow_sampler, surfaces.shadow_map),
                             sampled(surfaces.linear_sampler, surfaces.color_maps),
                             sampled(surfaces.linear_sampler, surfaces.glyphs),
                             sampled(surfaces.linear_sampler, inputs.textures.studio)};
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
    add_image(draw_binding::kStudio, images[3]);
    if (*surfaces.glyphs.view) {
      add_image(draw_binding::kGlyphs, images[2]);
    }
  }
  commands.pushDescriptorSetKHR(vk::PipelineBindPoint::eGraphics, *inputs.pipelines.draw_layout, 0,
                                writes);
}

void push_textures(const vk::raii::CommandBuffer& commands, const FrameInputs& inputs,
                   std::uint32_t material) {
  const MaterialTextures& textures = inputs.textures;
  const auto& roles = inputs.frame.materials[material].textures;
  std::array<vk::DescriptorImageInfo, kTextureRoles> images;
  for (std::size_t role = 0; role < kTextureRoles; ++role) {
    images[role] = vk::DescriptorImageInfo{*textures.samplers[sampler_row(roles[role])],
                                           *textures.images[textures.image_of[material][role]].view,
                                           vk::ImageLayout::eShaderReadOnlyOptimal};
  }
  commands.pushDescriptorSetKHR(vk::PipelineBindPoint::eGraphics, *inputs.pipelines.draw_layout, 0,
                                vk::WriteDescriptorSet{
                                    .dstBinding = draw_binding::kTextures,
                                    .descriptorCount = kTextureRoles,
                                    .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                                    .pImageInfo = images.data(),
                                });
}

void bind(const vk::raii::CommandBuffer& commands, const vk::raii::Pipeline& pipeline) {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
}

void bind_vertices(const vk::raii::CommandBuffer& commands,
                   std::initializer_list<vk::Buffer> buffers) {
  const std::vector<vk::DeviceSize> offsets(buffers.size(), 0);
  commands.bindVertexBuffers(0, vk::ArrayProxy<const vk::Buffer>(buffers), offsets);
}

void set_view(const vk::raii::CommandBuffer& commands, const vk::Rect2D& part) {
  commands.setViewport(
      0, vk::Viewport{static_cast<float>(part.offset.x), static_cast<float>(part.offset.y),
                      static_cast<float>(part.extent.width), static_cast<float>(part.extent.height),
                      0.0F, 1.0F});
  commands.setScissor(0, part);
}

}  // namespace torsion::engine
