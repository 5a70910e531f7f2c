#include "render/surfaces.hpp"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "render/colormap.hpp"
#include "render/pipelines.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kColorMapWidth = 256;

/// A row for each signed and unsigned heat map, at the places that frame_uniforms() gives in
/// heat_scale.z.
Image2d make_color_maps(const Gpu& gpu) {
  std::vector<std::uint8_t> texels;
  for (const HeatMap map : {HeatMap::kTwist, HeatMap::kPressure}) {
    for (std::uint32_t i = 0; i < kColorMapWidth; ++i) {
      const glm::dvec3 color = heat_color(map, i / (kColorMapWidth - 1.0));
      for (const double part : {color.x, color.y, color.z, 1.0}) {
        texels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * part)));
      }
    }
  }
  const std::array level = {std::as_bytes(std::span(texels))};
  return make_constant_image(gpu, {kColorMapWidth, 2}, vk::Format::eR8G8B8A8Srgb, level);
}

}  // namespace

void fit_surfaces(const Gpu& gpu, vk::Extent2D extent, vk::Format color_format,
                  vk::SampleCountFlagBits samples, Surfaces& surfaces) {
  using ImageUsage = vk::ImageUsageFlagBits;
  if (samples != vk::SampleCountFlagBits::e1) {
    surfaces.color = make_image(gpu, extent, color_format, samples,
                                ImageUsage::eColorAttachment | ImageUsage::eTransientAttachment);
  }
  surfaces.depth =
      make_image(gpu, extent, kDepthFormat, samples, ImageUsage::eDepthStencilAttachment);
}

Surfaces make_surfaces(const Gpu& gpu, std::uint32_t shadow_size, const OverlayAtlas* glyphs) {
  using ImageUsage = vk::ImageUsageFlagBits;
  Surfaces surfaces;
  surfaces.shadow_map =
      make_image(gpu, {2 * shadow_size, shadow_size}, kDepthFormat, vk::SampleCountFlagBits::e1,
                 ImageUsage::eDepthStencilAttachment | ImageUsage::eSampled);
  surfaces.color_maps = make_color_maps(gpu);
  if (glyphs != nullptr) {
    const std::array level = {std::as_bytes(std::span(glyphs->rgba))};
    surfaces.glyphs = make_constant_image(gpu, {glyphs->width, glyphs->height},
                                          vk::Format::eR8G8B8A8Unorm, level);
  }
  vk::SamplerCreateInfo sampler{
      .magFilter = vk::Filter::eLinear,
      .minFilter = vk::Filter::eLinear,
      .addressModeU = vk::SamplerAddressMode::eClampToEdge,
      .addressModeV = vk::SamplerAddressMode::eClampToEdge,
      .addressModeW = vk::SamplerAddressMode::eClampToEdge,
  };
  surfaces.linear_sampler = {gpu.device, sampler};
  // Outside the shadow map everything is lit.
  sampler.addressModeU = vk::SamplerAddressMode::eClampToBorder;
  sampler.addressModeV = vk::SamplerAddressMode::eClampToBorder;
  sampler.borderColor = vk::BorderColor::eFloatOpaqueWhite;
  sampler.compareEnable = VK_TRUE;
  sampler.compareOp = vk::CompareOp::eLessOrEqual;
  surfaces.shadow_sampler = {gpu.device, sampler};
  return surfaces;
}

}  // namespace torsion::engine
