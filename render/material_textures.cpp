#include "render/material_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "render/image_io.hpp"
#include "render/srgb.hpp"
#include "render/studio_light.hpp"
#include "shaders/shared.h"

namespace torsion::engine {
namespace {

/// An image of half the size: the mean of each four texels, in linear light.
Image halved(const Image& image, const std::array<double, 256>& linear) {
  Image half{std::max(image.width / 2, 1U), std::max(image.height / 2, 1U), {}};
  half.rgba.reserve(std::size_t{half.width} * half.height * 4);
  const auto texel = [&](std::uint32_t x, std::uint32_t y, std::uint32_t lane) {
    const std::size_t at =
        std::size_t{std::min(y, image.height - 1)} * image.width + std::min(x, image.width - 1);
    return image.rgba[4 * at + lane];
  };
  for (std::uint32_t y = 0; y < half.height; ++y) {
    for (std::uint32_t x = 0; x < half.width; ++x) {
      for (std::uint32_t lane = 0; lane < 3; ++lane) {
        const double sum =
            linear[texel(2 * x, 2 * y, lane)] + linear[texel(2 * x + 1, 2 * y, lane)] +
            linear[texel(2 * x, 2 * y + 1, lane)] + linear[texel(2 * x + 1, 2 * y + 1, lane)];
        half.rgba.push_back(
            static_cast<std::uint8_t>(std::lround(255.0 * srgb_encoded(0.25 * sum))));
      }
      half.rgba.push_back(255);
    }
  }
  return half;
}

Image2d make_texture(const Gpu& gpu, Image image) {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = srgb_decoded(static_cast<double>(i) / 255.0);
  }
  const vk::Extent2D extent{image.width, image.height};
  std::vector<Image> levels = {std::move(image)};
  while (levels.back().width > 1 || levels.back().height > 1) {
    levels.push_back(halved(levels.back(), linear));
  }
  std::vector<std::span<const std::byte>> bytes;
  bytes.reserve(levels.size());
  for (const Image& level : levels) {
    bytes.push_back(std::as_bytes(std::span(level.rgba)));
  }
  return make_constant_image(gpu, extent, vk::Format::eR8G8B8A8Srgb, bytes);
}

vk::SamplerAddressMode address_mode(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::kClamp:
      return vk::SamplerAddressMode::eClampToEdge;
    case TextureWrap::kMirror:
      return vk::SamplerAddressMode::eMirroredRepeat;
    case TextureWrap::kRepeat:
      break;
  }
  return vk::SamplerAddressMode::eRepeat;
}

vk::raii::Sampler make_sampler(const Gpu& gpu, const DrawMaterial& material) {
  return {gpu.device, vk::SamplerCreateInfo{
                          .magFilter = vk::Filter::eLinear,
                          .minFilter = vk::Filter::eLinear,
                          .mipmapMode = vk::SamplerMipmapMode::eLinear,
                          .addressModeU = address_mode(material.wrap_u),
                          .addressModeV = address_mode(material.wrap_v),
                          .maxLod = VK_LOD_CLAMP_NONE,
                      }};
}

}  // namespace

MaterialTextures make_material_textures(const Gpu& gpu,
                                        const std::vector<DrawMaterial>& materials) {
  MaterialTextures textures;
  textures.images.push_back(make_texture(gpu, {1, 1, {255, 255, 255, 255}}));
  std::vector<const EncodedImage*> decoded = {nullptr};  // (images)
  std::vector<float> roughness;
  for (const DrawMaterial& material : materials) {
    roughness.push_back(material.roughness);
    textures.samplers.push_back(make_sampler(gpu, material));
    const auto found = std::ranges::find(decoded, material.texture.get());
    std::uint32_t row = static_cast<std::uint32_t>(found - decoded.begin());
    if (found == decoded.end()) {
      Result<Image> image = decode_image(material.texture->bytes, gpu.limits.maxImageDimension2D);
      if (image) {
        decoded.push_back(material.texture.get());
        textures.images.push_back(make_texture(gpu, std::move(image).value()));
      } else {
        row = 0;
      }
    }
    textures.image_of.push_back(row);
  }
  const std::vector<std::uint16_t> texels = reflection_texels(roughness);
  const std::array level = {std::as_bytes(std::span(texels))};
  textures.studio = make_constant_image(
      gpu, {shared::kReflectionSide, shared::kReflectionSide * shared::kReflectionTiles},
      vk::Format::eR16G16B16A16Sfloat, level);
  return textures;
}

}  // namespace torsion::engine
