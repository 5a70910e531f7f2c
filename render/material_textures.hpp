#pragma once

#include <cstdint>
#include <vector>

#include "ecs/draw_material.hpp"
#include "render/memory.hpp"

namespace torsion::engine {

/// The textures of a scene's materials on the device, and the reflections that their roughness
/// needs.
struct MaterialTextures {
  std::vector<Image2d> images;              // the first is white, for materials without a texture
  std::vector<std::uint32_t> image_of;      // (materials) row of images; 0: none
  std::vector<vk::raii::Sampler> samplers;  // (materials)
  Image2d studio;
};

/// A texture that cannot be decoded is left out: warn_of_drawing() in app/ says so. Throws
/// vk::SystemError.
MaterialTextures make_material_textures(const Gpu& gpu, const std::vector<DrawMaterial>& materials);

}  // namespace torsion::engine
