#include "tests/support/image_compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/image_io.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kBlock = 8;  // pixels

int apart(const Image& a, const Image& b, std::size_t value) {
  return std::abs(int{a.rgba[value]} - int{b.rgba[value]});
}

/// Largest difference of the means of one channel over the block whose corner is (left, top).
double block_difference(const Image& a, const Image& b, std::uint32_t left, std::uint32_t top) {
  double sums[4] = {};
  const std::uint32_t right = std::min(left + kBlock, a.width);
  const std::uint32_t bottom = std::min(top + kBlock, a.height);
  for (std::uint32_t y = top; y < bottom; ++y) {
    for (std::uint32_t x = left; x < right; ++x) {
      for (std::size_t channel = 0; channel < 4; ++channel) {
        const std::size_t value = 4 * (std::size_t{y} * a.width + x) + channel;
        sums[channel] += static_cast<double>(a.rgba[value]) - static_cast<double>(b.rgba[value]);
      }
    }
  }
  double largest = 0.0;
  for (const double sum : sums) {
    largest = std::max(largest, std::abs(sum) / ((right - left) * (bottom - top)));
  }
  return largest;
}

}  // namespace

std::string ImageDifference::text() const {
  if (!same_size) {
    return "the pictures have different sizes";
  }
  return "largest difference " + std::to_string(largest) + "/255 at (" + std::to_string(x) + ", " +
         std::to_string(y) + "), " + std::to_string(100.0 * share_beyond_noise) +
         " % of values beyond noise, largest block mean " + std::to_string(largest_block) + "/255";
}

ImageDifference compare(const Image& actual, const Image& golden) {
  ImageDifference difference;
  difference.same_size = actual.width == golden.width && actual.height == golden.height &&
                         actual.rgba.size() == golden.rgba.size();
  if (!difference.same_size) {
    return difference;
  }
  std::size_t beyond = 0;
  for (std::size_t value = 0; value < actual.rgba.size(); ++value) {
    const int here = apart(actual, golden, value);
    beyond += here > kNoise ? 1U : 0U;
    if (here > difference.largest) {
      difference.largest = here;
      difference.x = static_cast<std::uint32_t>(value / 4 % actual.width);
      difference.y = static_cast<std::uint32_t>(value / 4 / actual.width);
    }
  }
  difference.share_beyond_noise = static_cast<double>(beyond) /
                                  static_cast<double>(std::max<std::size_t>(actual.rgba.size(), 1));
  for (std::uint32_t top = 0; top < actual.height; top += kBlock) {
    for (std::uint32_t left = 0; left < actual.width; left += kBlock) {
      difference.largest_block =
          std::max(difference.largest_block, block_difference(actual, golden, left, top));
    }
  }
  return difference;
}

bool close_enough(const ImageDifference& difference) {
  return difference.same_size && difference.share_beyond_noise <= kMostBeyondNoise &&
         difference.largest_block <= kMostBlock;
}

Image difference_picture(const Image& actual, const Image& golden) {
  Image picture{actual.width, actual.height, std::vector<std::uint8_t>(actual.rgba.size(), 255)};
  for (std::size_t pixel = 0; pixel < actual.rgba.size(); pixel += 4) {
    int largest = 0;
    for (std::size_t channel = 0; channel < 4; ++channel) {
      largest = std::max(largest, apart(actual, golden, pixel + channel));
    }
    std::fill_n(picture.rgba.begin() + static_cast<std::ptrdiff_t>(pixel), 3,
                static_cast<std::uint8_t>(std::min(8 * largest, 255)));
  }
  return picture;
}

testing::AssertionResult matches_golden(const Image& actual, const std::filesystem::path& golden,
                                        const std::filesystem::path& kept) {
  const Result<Image> expected = read_png(golden);
  const std::string name = golden.stem().string();
  const auto keep = [&](const Image& image, const std::string& what) {
    std::error_code none;  // the picture's own error says what is wrong
    std::filesystem::create_directories(kept, none);
    const Result<Done> written = write_png(image, kept / (name + "_" + what + ".png"));
    return written.ok() ? "" : written.error().text;
  };
  if (!expected) {
    return testing::AssertionFailure() << expected.error().text << keep(actual, "actual");
  }
  const ImageDifference difference = compare(actual, expected.value());
  if (close_enough(difference)) {
    return testing::AssertionSuccess() << difference.text();
  }
  testing::AssertionResult failure = testing::AssertionFailure();
  failure << name << ": " << difference.text() << "; see " << kept << keep(actual, "actual");
  if (difference.same_size) {
    failure << keep(difference_picture(actual, expected.value()), "difference");
  }
  return failure;
}

}  // namespace torsion::engine
