#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ecs/draw_material.hpp"
#include "render/memory.hpp"

namespace torsion::engine {

/// The textures of a scene's materials on the device, and the reflections that their roughness
/// needs.
struct MaterialTextures {
  std::vector<Image2d> images;  // the first is white, for what has no texture
  std::vector<std::array<std::uint32_t, kTextureRoles>> image_of;  // (materials) rows; 0: none
  std::vector<vk::raii::Sampler> samplers;                         // by sampler_row()
  Image2d studio;

  /// Bits of the roles of which a material has an image.
  [[nodiscard]] std::uint32_t bits(std::uint32_t material) const;
};

/// Which sampler repeats a texture as it should.
std::size_t sampler_row(const MaterialTexture& texture);

/// A texture that cannot be decoded is left out: warn_of_drawing() in app/ says so. Throws
/// vk::SystemError.
MaterialTextures make_material_textures(const Gpu& gpu, const std::vector<DrawMaterial>& materials);

}  // namespace torsion::engine
