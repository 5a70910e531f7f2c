#pragma once

#include <cstdint>

#include "render/memory.hpp"
#include "render/overlay_draw_list.hpp"

namespace torsion::engine {

/// Images and samplers that all frames share.
struct Surfaces {
  Image2d
      color;  // multisampled; empty with one sample a pixel, when the target is drawn to directly
  Image2d depth;
  Image2d shadow_map;
  Image2d color_maps;  // a row for each of twist and pressure
  Image2d glyphs;      // the overlay's atlas; empty without one
  vk::raii::Sampler shadow_sampler = nullptr;
  vk::raii::Sampler linear_sampler = nullptr;
};

/// All that has a size of its own.
/// @param shadow_size  texels along the side of the shadow map
/// @param glyphs       copied; may be null
Surfaces make_surfaces(const Gpu& gpu, std::uint32_t shadow_size, const OverlayAtlas* glyphs);

/// What has the size of the scene's picture.
void fit_surfaces(const Gpu& gpu, vk::Extent2D extent, vk::Format color_format,
                  vk::SampleCountFlagBits samples, Surfaces& surfaces);

}  // namespace torsion::engine
