#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "render/image.hpp"

namespace torsion::engine {

/// How far two pictures of one size are from each other.
struct ImageDifference {
  bool same_size = false;
  int largest = 0;                  // of any channel of any pixel, 0 to 255
  double share_beyond_noise = 0.0;  // of channel values that differ by more than kNoise
  double largest_block = 0.0;       // largest difference of the means of an 8 x 8 block's channel
  std::uint32_t x = 0;              // of the pixel with the largest difference
  std::uint32_t y = 0;

  [[nodiscard]] std::string text() const;
};

// Drivers round differently: measured between llvmpipe's vector widths there is none at all,
// between drivers at most 2 along edges. A block catches a small thing that is missing in a large
// picture.
inline constexpr int kNoise = 2;
inline constexpr double kMostBeyondNoise = 0.005;
inline constexpr double kMostBlock = 8.0;

ImageDifference compare(const Image& actual, const Image& golden);

/// True when the pictures count as the same.
bool close_enough(const ImageDifference& difference);

/// Where they differ: black where they agree, up to white where they are 32 or more apart.
/// @pre both have one size
Image difference_picture(const Image& actual, const Image& golden);

/// Whether `actual` is what the PNG `golden` holds; a missing one is a failure. Where not, leaves
/// NAME_actual.png and NAME_difference.png in the folder `kept`.
testing::AssertionResult matches_golden(const Image& actual, const std::filesystem::path& golden,
                                        const std::filesystem::path& kept);

}  // namespace torsion::engine
