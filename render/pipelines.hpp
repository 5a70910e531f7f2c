#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/gpu.hpp"
#include "shaders/shared.h"

namespace torsion::engine {

/// Binding numbers of the draws, the same for all of them; the shaders name them too.
namespace draw_binding {
inline constexpr std::uint32_t kUniforms = 0;
inline constexpr std::uint32_t kShadowMap = 1;
inline constexpr std::uint32_t kColorMaps = 2;
inline constexpr std::uint32_t kContacts = 3;
inline constexpr std::uint32_t kGlyphs = 4;
inline constexpr std::uint32_t kStudio = 5;
inline constexpr std::uint32_t kTextures = 6;  // kTextureRoles of them
}  // namespace draw_binding

/// Bindings of either compute shader: storage buffers, then texel buffers.
inline constexpr std::uint32_t kStorageBindings = 5;
inline constexpr std::uint32_t kTexelBindings = 2;
inline constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;

/// Bits of the textures that a pipeline reads: a material takes the first that has all of its own.
inline constexpr std::array<std::uint32_t, 3> kReadTextures = {0, 1U << shared::kBaseColor,
                                                               (1U << shared::kTextures) - 1};

/// How a surface covers what is behind it. Those that no material needs are null.
struct SurfacePipelines {
  std::vector<vk::raii::Pipeline> solid;     // (kReadTextures)
  vk::raii::Pipeline cut_out = nullptr;      // pixels of little alpha are not there; all textures
  vk::raii::Pipeline glass_depth = nullptr;  // the nearest surface, depth only
  std::vector<vk::raii::Pipeline> glass;     // (kReadTextures): blended over what is behind, where
                                             // it is the nearest
};

/// What of the surfaces' pipelines a scene needs; tools may be glass whatever their materials say.
struct SurfaceNeeds {
  std::array<bool, kReadTextures.size()> read{};
  bool cut_out = false;
  bool glass_bodies = false;
};

/// Which of kReadTextures has all of these bits.
std::size_t read_textures_row(std::uint32_t textures);

/// All pipelines, and the layouts that they share. Members are in the order of creation.
struct Pipelines {
  vk::raii::DescriptorSetLayout compute_bindings = nullptr;
  vk::raii::DescriptorSetLayout draw_bindings = nullptr;
  vk::raii::PipelineLayout compute_layout = nullptr;
  vk::raii::PipelineLayout draw_layout = nullptr;

  std::vector<vk::raii::Pipeline> deform;  // kNoRegion, kOneRegion, kManyRegions
  vk::raii::Pipeline normals = nullptr;
  vk::raii::Pipeline shadow = nullptr;
  vk::raii::Pipeline cut_out_shadow = nullptr;
  vk::raii::Pipeline ground = nullptr;
  SurfacePipelines body;
  vk::raii::Pipeline arrow = nullptr;
  SurfacePipelines tool;
  vk::raii::Pipeline overlay = nullptr;
};

/// A pipeline that draws the overlay alone over an image of that format, which keeps encoded
/// colours, one sample a pixel; glyphs must lie on whole pixels.
vk::raii::Pipeline make_overlay_pipeline(const Gpu& gpu, const Pipelines& pipelines,
                                         vk::Format color_format);

/// @param quick   harder shadows, light at the corners of triangles: kQuick in the shaders
/// @param texels  compute shaders read rows as texels where they can. Throws vk::SystemError.
Pipelines make_pipelines(const Gpu& gpu, vk::Format color_format, vk::SampleCountFlagBits samples,
                         const SurfaceNeeds& needs, bool quick, bool texels);

}  // namespace torsion::engine
