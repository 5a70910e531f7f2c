#pragma once

// What tests look for in pictures of the window.

#include <cstdint>
#include <cstdlib>

#include "render/image.hpp"

namespace torsion::test {

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

}  // namespace torsion::test
