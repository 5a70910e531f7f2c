#include "tests/support/image_compare.hpp"

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

Image gray(std::uint32_t width, std::uint32_t height, std::uint8_t level) {
  return {width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, level)};
}

TEST(ImageCompareTest, EqualPicturesAreTheSame) {
  const ImageDifference difference = compare(gray(64, 48, 100), gray(64, 48, 100));
  EXPECT_TRUE(close_enough(difference));
  EXPECT_EQ(difference.largest, 0);
}

TEST(ImageCompareTest, NoiseOfADriverIsLetThrough) {
  Image noisy = gray(64, 48, 100);
  for (std::size_t i = 0; i < noisy.rgba.size(); i += 3) {
    noisy.rgba[i] = 102;
  }
  EXPECT_TRUE(close_enough(compare(noisy, gray(64, 48, 100))));
}

TEST(ImageCompareTest, AFewBadPixelsAreLetThroughManyAreNot) {
  Image few = gray(200, 200, 100);
  few.rgba[4 * 777] = 130;
  EXPECT_TRUE(close_enough(compare(few, gray(200, 200, 100))));
  Image many = gray(200, 200, 100);
  for (std::size_t i = 0; i < many.rgba.size(); i += 100) {
    many.rgba[i] = 110;
  }
  EXPECT_FALSE(close_enough(compare(many, gray(200, 200, 100))));
}

TEST(ImageCompareTest, ASmallThingThatIsMissingIsSeen) {
  Image with_spot = gray(512, 512, 100);
  for (std::uint32_t y = 160; y < 166; ++y) {
    for (std::uint32_t x = 80; x < 86; ++x) {
      with_spot.rgba[4 * (y * 512 + x)] = 130;
    }
  }
  const ImageDifference difference = compare(gray(512, 512, 100), with_spot);
  EXPECT_LT(difference.share_beyond_noise, kMostBeyondNoise);
  EXPECT_FALSE(close_enough(difference));
  EXPECT_EQ(difference.x, 80U);
  EXPECT_EQ(difference.y, 160U);
}

TEST(ImageCompareTest, OtherSizesAreNotTheSame) {
  EXPECT_FALSE(close_enough(compare(gray(64, 48, 100), gray(48, 64, 100))));
}

TEST(ImageCompareTest, DifferencePictureIsBrightWhereTheyDiffer) {
  Image changed = gray(8, 8, 100);
  changed.rgba[4 * 9 + 1] = 110;
  const Image picture = difference_picture(changed, gray(8, 8, 100));
  EXPECT_EQ(picture.rgba[4 * 9], 80);
  EXPECT_EQ(picture.rgba[0], 0);
  EXPECT_EQ(picture.rgba[3], 255);
}

}  // namespace
}  // namespace torsion::engine
