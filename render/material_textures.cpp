#include "render/material_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "render/image_io.hpp"
#include "render/srgb.hpp"
#include "render/studio_light.hpp"
#include "shaders/shared.h"

namespace torsion::engine {
namespace {

/// What a byte of a colour stands for: linear light, or a number as it is.
using Decoded = std::array<double, 256>;

Decoded decoded_bytes(bool encoded) {
  Decoded values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    values[i] = encoded ? srgb_decoded(value) : value;
  }
  return values;
}

/// An image of half the size: the mean of each four texels, of colours in linear light.
/// @param encoded  its colours are sRGB
Image halved(const Image& image, bool encoded, const Decoded& decoded) {
  Image half{std::max(image.width / 2, 1U), std::max(image.height / 2, 1U), {}};
  half.rgba.reserve(std::size_t{half.width} * half.height * 4);
  const auto texel = [&](std::uint32_t x, std::uint32_t y, std::uint32_t lane) {
    const std::size_t at =
        std::size_t{std::min(y, image.height - 1)} * image.width + std::min(x, image.width - 1);
    return image.rgba[4 * at + lane];
  };
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(255.0 * value));
  };
  for (std::uint32_t y = 0; y < half.height; ++y) {
    for (std::uint32_t x = 0; x < half.width; ++x) {
      for (std::uint32_t lane = 0; lane < 3; ++lane) {
        const double mean =
            0.25 *
            (decoded[texel(2 * x, 2 * y, lane)] + decoded[texel(2 * x + 1, 2 * y, lane)] +
             decoded[texel(2 * x, 2 * y + 1, lane)] + decoded[texel(2 * x + 1, 2 * y + 1, lane)]);
        half.rgba.push_back(byte(encoded ? srgb_encoded(mean) : mean));
      }
      const int alpha = texel(2 * x, 2 * y, 3) + texel(2 * x + 1, 2 * y, 3) +
                        texel(2 * x, 2 * y + 1, 3) + texel(2 * x + 1, 2 * y + 1, 3);
      half.rgba.push_back(static_cast<std::uint8_t>((alpha + 2) / 4));
    }
  }
  return half;
}

Image2d make_texture(const Gpu& gpu, Image image, bool encoded) {
  const Decoded decoded = decoded_bytes(encoded);
  const vk::Extent2D extent{image.width, image.height};
  std::vector<Image> levels = {std::move(image)};
  while (levels.back().width > 1 || levels.back().height > 1) {
    levels.push_back(halved(levels.back(), encoded, decoded));
  }
  std::vector<std::span<const std::byte>> bytes;
  bytes.reserve(levels.size());
  for (const Image& level : levels) {
    bytes.push_back(std::as_bytes(std::span(level.rgba)));
  }
  return make_constant_image(
      gpu, extent, encoded ? vk::Format::eR8G8B8A8Srgb : vk::Format::eR8G8B8A8Unorm, bytes);
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

constexpr std::array kWraps = {TextureWrap::kRepeat, TextureWrap::kMirror, TextureWrap::kClamp};

vk::raii::Sampler make_sampler(const Gpu& gpu, TextureWrap wrap_u, TextureWrap wrap_v) {
  return {gpu.device, vk::SamplerCreateInfo{
                          .magFilter = vk::Filter::eLinear,
                          .minFilter = vk::Filter::eLinear,
                          .mipmapMode = vk::SamplerMipmapMode::eLinear,
                          .addressModeU = address_mode(wrap_u),
                          .addressModeV = address_mode(wrap_v),
                          .maxLod = VK_LOD_CLAMP_NONE,
                      }};
}

bool is_encoded(TextureRole role) {
  return role == TextureRole::kBaseColor || role == TextureRole::kEmission;
}

/// An image on the device.
struct Uploaded {
  const EncodedImage* source = nullptr;
  bool encoded = false;      // its colours are sRGB
  std::uint32_t row = 0;     // of the images; 0: it cannot be decoded
  float least_green = 1.0F;  // 0 to 1
  float most_green = 1.0F;
};

Uploaded upload(const Gpu& gpu, const EncodedImage& source, bool encoded,
                std::vector<Image2d>& images) {
  Uploaded uploaded{&source, encoded};
  Result<Image> decoded = decode_image(source.bytes, gpu.limits.maxImageDimension2D);
  if (!decoded) {
    return uploaded;
  }
  Image image = std::move(decoded).value();
  std::uint8_t least = 255;
  std::uint8_t most = 0;
  for (std::size_t i = 1; i < image.rgba.size(); i += 4) {
    least = std::min(least, image.rgba[i]);
    most = std::max(most, image.rgba[i]);
  }
  uploaded.least_green = static_cast<float>(least) / 255.0F;
  uploaded.most_green = static_cast<float>(most) / 255.0F;
  uploaded.row = static_cast<std::uint32_t>(images.size());
  images.push_back(make_texture(gpu, std::move(image), encoded));
  return uploaded;
}

/// The roughness of a material's pixels: its own, or all steps of the reflections between the least
/// and the most of its texture.
void add_roughness(const DrawMaterial& material, const std::optional<Uploaded>& texture,
                   std::vector<float>& roughness) {
  if (!texture || texture->row == 0) {
    roughness.push_back(material.roughness);
    return;
  }
  constexpr float kSteps = shared::kReflectionTiles - 1;
  const float first = std::floor(kSteps * material.roughness * texture->least_green);
  const float last = std::ceil(kSteps * material.roughness * texture->most_green);
  for (float step = first; step <= last; step += 1.0F) {
    roughness.push_back(step / kSteps);
  }
}

}  // namespace

std::uint32_t MaterialTextures::bits(std::uint32_t material) const {
  std::uint32_t bits = 0;
  for (std::uint32_t role = 0; role < kTextureRoles; ++role) {
    bits |= image_of[material][role] != 0 ? 1U << role : 0U;
  }
  return bits;
}

std::size_t sampler_row(const MaterialTexture& texture) {
  const auto row = [](TextureWrap wrap) {
    return static_cast<std::size_t>(std::ranges::find(kWraps, wrap) - kWraps.begin());
  };
  return row(texture.wrap_u) * kWraps.size() + row(texture.wrap_v);
}

MaterialTextures make_material_textures(const Gpu& gpu,
                                        const std::vector<DrawMaterial>& materials) {
  MaterialTextures textures;
  textures.images.push_back(make_texture(gpu, {1, 1, {255, 255, 255, 255}}, true));
  for (const TextureWrap u : kWraps) {
    for (const TextureWrap v : kWraps) {
      textures.samplers.push_back(make_sampler(gpu, u, v));
    }
  }
  std::vector<Uploaded> uploaded;
  std::vector<float> roughness;
  for (const DrawMaterial& material : materials) {
    auto& rows = textures.image_of.emplace_back();
    std::optional<Uploaded> of_roughness;
    for (std::size_t role = 0; role < kTextureRoles; ++role) {
      const EncodedImage* source = material.textures[role].image.get();
      if (source == nullptr) {
        continue;
      }
      const bool encoded = is_encoded(static_cast<TextureRole>(role));
      auto found = std::ranges::find_if(uploaded, [&](const Uploaded& there) {
        return there.source == source && there.encoded == encoded;
      });
      if (found == uploaded.end()) {
        found = uploaded.insert(found, upload(gpu, *source, encoded, textures.images));
      }
      rows[role] = found->row;
      if (static_cast<TextureRole>(role) == TextureRole::kMetalRoughness) {
        of_roughness = *found;
      }
    }
    add_roughness(material, of_roughness, roughness);
  }
  const std::vector<std::uint16_t> texels = reflection_texels(roughness);
  const std::array level = {std::as_bytes(std::span(texels))};
  textures.studio = make_constant_image(
      gpu, {shared::kReflectionSide, shared::kReflectionSide * shared::kReflectionTiles},
      vk::Format::eR16G16B16A16Sfloat, level);
  return textures;
}

}  // namespace torsion::engine
