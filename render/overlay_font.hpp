#pragma once

#include <string_view>

#include "render/overlay_draw_list.hpp"

namespace torsion::engine {

/// Glyphs of one size, drawn once into an atlas. ASCII, and the degree sign.
class OverlayFont {
 public:
  /// @param height  pixels from one line to the next, 8 to 128
  explicit OverlayFont(double height);

  [[nodiscard]] const OverlayAtlas& atlas() const { return atlas_; }
  [[nodiscard]] double line_height() const { return line_height_; }  // pixels

  /// Width of a text in pixels. `text` is ASCII, or UTF-8 with the degree sign; other characters
  /// show as '?'.
  [[nodiscard]] double width_of(std::string_view text) const;

  /// Appends a text whose line begins at (x, y), its top left corner, pixels.
  void append_text(OverlayDrawList& list, std::string_view text, double x, double y,
                   std::uint32_t rgba) const;

  /// Appends a filled rectangle, pixels.
  void append_box(OverlayDrawList& list, double left, double top, double right, double bottom,
                  std::uint32_t rgba) const;

 private:
  struct Glyph {
    float left, top, right, bottom;  // pixels about the pen on the base line
    float u0, v0, u1, v1;
    float advance;
  };
  static constexpr int kFirst = 32;
  static constexpr int kCount = 95 + 1;  // ASCII, and the degree sign at the end
  [[nodiscard]] const Glyph& glyph(char32_t letter) const;

  OverlayAtlas atlas_;
  std::vector<Glyph> glyphs_;
  double line_height_ = 0.0;
  double ascent_ = 0.0;  // pixels from the top of a line to its base line
  float solid_u_ = 0.0F;
  float solid_v_ = 0.0F;
};

}  // namespace torsion::engine
