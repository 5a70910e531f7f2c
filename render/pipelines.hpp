#pragma once

#include <cstdint>
#include <vector>

#include "render/gpu.hpp"

namespace torsion::engine {

/// Binding numbers of the draws, the same for all of them; the shaders name them too.
namespace draw_binding {
inline constexpr std::uint32_t kUniforms = 0;
inline constexpr std::uint32_t kShadowMap = 1;
inline constexpr std::uint32_t kColorMaps = 2;
inline constexpr std::uint32_t kContacts = 3;
inline constexpr std::uint32_t kGlyphs = 4;
inline constexpr std::uint32_t kStudio = 5;
inline constexpr std::uint32_t kBaseColor = 6;
}  // namespace draw_binding

/// Bindings of either compute shader: storage buffers, then texel buffers.
inline constexpr std::uint32_t kStorageBindings = 5;
inline constexpr std::uint32_t kTexelBindings = 2;
inline constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;

/// All pipelines, and the layouts that they share. Members are in the order of creation.
struct Pipelines {
  vk::raii::DescriptorSetLayout compute_bindings = nullptr;
  vk::raii::DescriptorSetLayout draw_bindings = nullptr;
  vk::raii::PipelineLayout compute_layout = nullptr;
  vk::raii::PipelineLayout draw_layout = nullptr;

  std::vector<vk::raii::Pipeline> deform;  // kNoRegion, kOneRegion, kManyRegions
  vk::raii::Pipeline normals = nullptr;
  vk::raii::Pipeline shadow = nullptr;
  vk::raii::Pipeline ground = nullptr;
  vk::raii::Pipeline body = nullptr;
  vk::raii::Pipeline arrow = nullptr;
  vk::raii::Pipeline tool_depth = nullptr;  // the tool's nearest surface, depth only
  vk::raii::Pipeline tool = nullptr;        // blended over what is behind, where it is the nearest
  vk::raii::Pipeline overlay = nullptr;
};

/// A pipeline that draws the overlay alone over an image of that format, which keeps encoded
/// colours, one sample a pixel; glyphs must lie on whole pixels.
vk::raii::Pipeline make_overlay_pipeline(const Gpu& gpu, const Pipelines& pipelines,
                                         vk::Format color_format);

/// @param quick   harder shadows, for a third of their time
/// @param texels  compute shaders read rows as texels where they can. Throws vk::SystemError.
Pipelines make_pipelines(const Gpu& gpu, vk::Format color_format, vk::SampleCountFlagBits samples,
                         bool quick, bool texels);

}  // namespace torsion::engine
