#pragma once

// What the overlay's maker (render/overlay.hpp) hands to the renderer: triangles in pixels over the
// finished picture.

#include <cstdint>
#include <vector>

namespace torsion::engine {

/// One corner. Its colour is multiplied by the atlas's at (u, v), alpha too, which is how much of
/// it covers the picture.
struct OverlayVertex {
  float x = 0.0F;          // pixels from the left edge
  float y = 0.0F;          // pixels from the top edge
  float u = 0.0F;          // 0 to 1 over the atlas, from the left
  float v = 0.0F;          // 0 to 1 over the atlas, from the top
  std::uint32_t rgba = 0;  // sRGB bytes, R lowest (Dear ImGui's IM_COL32), alpha not premultiplied
};

/// Glyphs and one solid patch, white with their coverage as alpha, and pictures; rows from the top.
struct OverlayAtlas {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height: sRGB and alpha, not premultiplied
};

/// A run of indices of which only what lies in a rectangle is drawn.
struct OverlayClip {
  std::uint32_t first = 0;  // of the indices
  std::uint32_t count = 0;
  std::int32_t left = 0;  // pixels, of the target
  std::int32_t top = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Pixels of the target that a panel covers, all of them.
struct OverlayPanel {
  std::int32_t left = 0;
  std::int32_t top = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Triangles, drawn in order, blended one over the other.
struct OverlayDrawList {
  std::vector<OverlayVertex> vertices;
  std::vector<std::uint32_t> indices;  // three for each triangle
  std::vector<OverlayClip> clips;      // in order; empty: all indices, unclipped
  // Of a window's overlay: the last clips are of opaque panels, which may be kept from picture to
  // picture; what is before them lies over the scene.
  std::size_t panel_clips = 0;
  std::vector<OverlayPanel> panels;
};

}  // namespace torsion::engine
