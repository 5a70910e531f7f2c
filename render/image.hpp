#pragma once

#include <cstdint>
#include <vector>

namespace torsion::engine {

/// A picture: sRGB-encoded bytes R, G, B, A; rows from the top, pixels from the left, no padding.
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4

  bool operator==(const Image&) const = default;
};

}  // namespace torsion::engine
