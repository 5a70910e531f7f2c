#pragma once

// What tests look for in pictures of the window.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "render/image.hpp"

namespace torsion::engine::test {

/// Whether the upper middle has the banner's red on it.
inline bool has_red_banner(const Image& image) {
  std::uint32_t red = 0;
  for (std::uint32_t y = 8; y < 60; ++y) {
    for (std::uint32_t x = image.width / 3; x < 2 * image.width / 3; ++x) {
      const std::size_t at = 4 * (std::size_t{y} * image.width + x);
      red += image.rgba[at] > 180 && image.rgba[at + 1] < 70 && image.rgba[at + 2] < 70 ? 1U : 0U;
    }
  }
  return red > 1000;
}

/// Share of the pixels of a rectangle in which a colour differs by more than 8 of 255.
inline double changed(const Image& a, const Image& b, std::uint32_t left, std::uint32_t top,
                      std::uint32_t right, std::uint32_t bottom) {
  std::uint32_t count = 0;
  for (std::uint32_t y = top; y < bottom; ++y) {
    for (std::uint32_t x = left; x < right; ++x) {
      const std::size_t at = 4 * (std::size_t{y} * a.width + x);
      bool differs = false;
      for (std::size_t i = at; i < at + 3; ++i) {
        differs = differs || std::abs(int{a.rgba[i]} - int{b.rgba[i]}) > 8;
      }
      count += differs ? 1U : 0U;
    }
  }
  return count / (static_cast<double>(right - left) * (bottom - top));
}

}  // namespace torsion::engine::test
