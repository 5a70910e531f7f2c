#pragma once

#include <span>
#include <vector>

#include "render/image.hpp"
#include "render/overlay_draw_list.hpp"

namespace torsion::engine {

/// A picture in the atlas; width 0: there is none.
struct AtlasPicture {
  float width = 0.0F;  // pixels
  float height = 0.0F;
  float u0 = 0.0F;
  float v0 = 0.0F;
  float u1 = 0.0F;
  float v1 = 0.0F;
};

/// A scene's picture as it is, and a third as large along each side.
struct CardPictures {
  AtlasPicture large;
  AtlasPicture small;
};

/// Dear ImGui's glyphs and a solid patch, and the pictures in two sizes each.
/// @param pictures  empty ones are left out
/// @param cards     gets where they are, one row for each picture
/// @pre Dear ImGui has a context, whose atlas has not been made
OverlayAtlas make_atlas(std::span<const Image> pictures, std::vector<CardPictures>& cards);

}  // namespace torsion::engine
