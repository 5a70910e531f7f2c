#include "render/overlay_font.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wcast-align"
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

#include "ecs/assert.hpp"

// DejaVu Sans, in the program, so that it needs no file at run time.
extern "C" {
extern const unsigned char torsion_font_begin[];
extern const unsigned char torsion_font_end[];
}
__asm__(
    ".section .rodata\n"
    ".global torsion_font_begin\n"
    ".global torsion_font_end\n"
    "torsion_font_begin:\n"
    ".incbin \"" TORSION_FONT_FILE
    "\"\n"
    "torsion_font_end:\n"
    ".byte 0\n"
    ".text\n");

namespace torsion::engine {
namespace {

constexpr int kAtlasSide = 1024;  // texels
constexpr std::size_t kAtlasTexels = std::size_t{kAtlasSide} * kAtlasSide;
constexpr char32_t kDegree = 0xB0;

/// The next character of UTF-8 text; what is cut off or not UTF-8 counts as '?'.
char32_t next_letter(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  text.remove_prefix(1);
  if (first < 0x80) {
    return first;
  }
  if (first >= 0xC2 && first < 0xE0 && !text.empty()) {
    const auto second = static_cast<unsigned char>(text.front());
    text.remove_prefix(1);
    return (static_cast<char32_t>(first & 0x1FU) << 6U) | (second & 0x3FU);
  }
  while (!text.empty() && (static_cast<unsigned char>(text.front()) & 0xC0U) == 0x80U) {
    text.remove_prefix(1);
  }
  return U'?';
}

}  // namespace

OverlayFont::OverlayFont(double height) {
  const float size = static_cast<float>(std::clamp(height, 8.0, 128.0)) / 1.2F;
  std::vector<std::uint8_t> alpha(kAtlasTexels, 0);
  std::array<stbtt_packedchar, kCount> packed{};
  stbtt_pack_context context;
  stbtt_PackBegin(&context, alpha.data(), kAtlasSide, kAtlasSide, 0, 2, nullptr);
  const int ascii =
      stbtt_PackFontRange(&context, torsion_font_begin, 0, size, kFirst, kCount - 1, packed.data());
  const int degree = stbtt_PackFontRange(&context, torsion_font_begin, 0, size, kDegree, 1,
                                         packed.data() + kCount - 1);
  stbtt_PackEnd(&context);
  TORSION_ASSERT(ascii != 0 && degree != 0);
  for (const stbtt_packedchar& from : packed) {
    constexpr auto kSide = static_cast<float>(kAtlasSide);
    glyphs_.push_back({from.xoff, from.yoff, from.xoff2, from.yoff2,
                       static_cast<float>(from.x0) / kSide, static_cast<float>(from.y0) / kSide,
                       static_cast<float>(from.x1) / kSide, static_cast<float>(from.y1) / kSide,
                       from.xadvance});
  }
  // A solid patch in the last corner, which the packing leaves free.
  for (std::size_t row = 1; row <= 4; ++row) {
    std::fill_n(alpha.end() - static_cast<std::ptrdiff_t>((row - 1) * kAtlasSide + 4), 4,
                std::uint8_t{255});
  }
  atlas_ = {kAtlasSide, kAtlasSide, std::vector<std::uint8_t>(4 * kAtlasTexels, 255)};
  for (std::size_t i = 0; i < kAtlasTexels; ++i) {
    atlas_.rgba[4 * i + 3] = alpha[i];
  }
  solid_u_ = solid_v_ = 1.0F - 2.0F / static_cast<float>(kAtlasSide);
  line_height_ = 1.2 * static_cast<double>(size);
  ascent_ = 0.93 * static_cast<double>(size);
}

const OverlayFont::Glyph& OverlayFont::glyph(char32_t letter) const {
  if (letter == kDegree) {
    return glyphs_.back();
  }
  const bool known = letter >= kFirst && letter < kFirst + kCount - 1;
  return glyphs_[(known ? letter : U'?') - kFirst];
}

double OverlayFont::width_of(std::string_view text) const {
  double width = 0.0;
  while (!text.empty()) {
    width += static_cast<double>(glyph(next_letter(text)).advance);
  }
  return width;
}

void OverlayFont::append_text(OverlayDrawList& list, std::string_view text, double x, double y,
                              std::uint32_t rgba) const {
  auto pen = static_cast<float>(std::round(x));
  const auto base = static_cast<float>(std::round(y + ascent_));
  while (!text.empty()) {
    const Glyph& g = glyph(next_letter(text));
    const auto first = static_cast<std::uint32_t>(list.vertices.size());
    list.vertices.push_back({pen + g.left, base + g.top, g.u0, g.v0, rgba});
    list.vertices.push_back({pen + g.right, base + g.top, g.u1, g.v0, rgba});
    list.vertices.push_back({pen + g.right, base + g.bottom, g.u1, g.v1, rgba});
    list.vertices.push_back({pen + g.left, base + g.bottom, g.u0, g.v1, rgba});
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
      list.indices.push_back(first + corner);
    }
    pen += g.advance;
  }
}

void OverlayFont::append_box(OverlayDrawList& list, double left, double top, double right,
                             double bottom, std::uint32_t rgba) const {
  const auto first = static_cast<std::uint32_t>(list.vertices.size());
  const auto corner = [&](double x, double y) {
    list.vertices.push_back(
        {static_cast<float>(x), static_cast<float>(y), solid_u_, solid_v_, rgba});
  };
  corner(left, top);
  corner(right, top);
  corner(right, bottom);
  corner(left, bottom);
  for (const std::uint32_t index : {0U, 1U, 2U, 0U, 2U, 3U}) {
    list.indices.push_back(first + index);
  }
}

}  // namespace torsion::engine
