#include "app/view/gui_atlas.hpp"

#include <algorithm>
#include <cstddef>

#include <imgui.h>

namespace torsion::engine {
namespace {

constexpr float kFontSize = 15.0F;  // pixels
constexpr const char* kFontFile = TORSION_FONT_FILE;

/// A picture and where it goes in the atlas.
struct Placed {
  Image image;
  int place = 0;  // ImFontAtlas's number of its rectangle
};

/// A third as large along each side, by means.
Image third(const Image& image) {
  Image small{image.width / 3, image.height / 3, {}};
  small.rgba.resize(std::size_t{4} * small.width * small.height);
  for (std::uint32_t y = 0; y < small.height; ++y) {
    for (std::uint32_t x = 0; x < small.width; ++x) {
      for (std::uint32_t channel = 0; channel < 4; ++channel) {
        std::uint32_t sum = 0;
        for (std::uint32_t i = 0; i < 9; ++i) {
          const std::size_t row = std::size_t{3} * y + i / 3;
          const std::size_t from = row * image.width + std::size_t{3} * x + i % 3;
          sum += image.rgba[4 * from + channel];
        }
        small.rgba[4 * (std::size_t{y} * small.width + x) + channel] =
            static_cast<std::uint8_t>(sum / 9);
      }
    }
  }
  return small;
}

/// Both sizes of all pictures, one after the other, each with its place.
std::vector<Placed> place(std::span<const Image> pictures) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  std::vector<Placed> placed;
  for (const Image& picture : pictures) {
    for (Image image : {picture, third(picture)}) {
      const bool empty = image.width == 0 || image.height == 0;
      const int number = empty ? -1
                               : fonts.AddCustomRectRegular(static_cast<int>(image.width),
                                                            static_cast<int>(image.height));
      placed.push_back({std::move(image), number});
    }
  }
  return placed;
}

AtlasPicture copy_into(OverlayAtlas& atlas, const Placed& placed) {
  if (placed.place < 0) {
    return {};
  }
  const ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  const ImFontAtlasCustomRect& at = *ImGui::GetIO().Fonts->GetCustomRectByIndex(placed.place);
  const std::size_t row_bytes = std::size_t{4} * placed.image.width;
  for (std::size_t row = 0; row < placed.image.height; ++row) {
    const auto from = placed.image.rgba.begin() + static_cast<std::ptrdiff_t>(row * row_bytes);
    const std::size_t to = 4 * ((at.Y + row) * atlas.width + at.X);
    std::copy_n(from, row_bytes, atlas.rgba.begin() + static_cast<std::ptrdiff_t>(to));
  }
  ImVec2 low;
  ImVec2 high;
  fonts.CalcCustomRectUV(&at, &low, &high);
  return {static_cast<float>(placed.image.width),
          static_cast<float>(placed.image.height),
          low.x,
          low.y,
          high.x,
          high.y};
}

}  // namespace

OverlayAtlas make_atlas(std::span<const Image> pictures, std::vector<CardPictures>& cards) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  // The degree sign and the like, and a few Greek letters, arrows and signs that units and keys
  // need.
  static const ImWchar ranges[] = {0x0020, 0x00FF, 0x0391, 0x03C9, 0x2016, 0x2016, 0x2190, 0x2193,
                                   0x21BB, 0x21BB, 0x25B6, 0x25B6, 0x2630, 0x2630, 0};
  fonts.AddFontFromFileTTF(kFontFile, kFontSize, nullptr, ranges);
  const std::vector<Placed> placed = place(pictures);
  unsigned char* rgba = nullptr;
  int width = 0;
  int height = 0;
  fonts.GetTexDataAsRGBA32(&rgba, &width, &height);
  OverlayAtlas atlas{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  atlas.rgba.assign(rgba, rgba + std::ptrdiff_t{4} * width * height);
  for (std::size_t i = 0; i < placed.size(); i += 2) {
    cards.push_back({copy_into(atlas, placed[i]), copy_into(atlas, placed[i + 1])});
  }
  return atlas;
}

}  // namespace torsion::engine
