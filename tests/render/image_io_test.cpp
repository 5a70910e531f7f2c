#include "render/image_io.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

class ImageIoTest : public testing::Test {
 protected:
  ImageIoTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("torsion_image_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ImageIoTest() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(ImageIoTest, WhatIsWrittenIsReadBack) {
  Image image{7, 5, {}};
  for (std::uint32_t i = 0; i < 7 * 5 * 4; ++i) {
    image.rgba.push_back(static_cast<std::uint8_t>(37 * i));
  }
  ASSERT_TRUE(write_png(image, folder_ / "a.png").ok());
  const Result<Image> read = read_png(folder_ / "a.png");
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_EQ(read.value(), image);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(ImageIoTest, AFolderThatIsNotThereIsSaid) {
  const Result<Done> done = write_png({1, 1, {0, 0, 0, 0}}, folder_ / "no" / "a.png");
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().text.find("cannot be written"), std::string::npos);
}

TEST_F(ImageIoTest, WhatIsNotAPictureIsRefused) {
  std::ofstream(folder_ / "b.png") << "not a picture";
  EXPECT_FALSE(read_png(folder_ / "b.png").ok());
  EXPECT_FALSE(read_png(folder_ / "none.png").ok());
}

TEST_F(ImageIoTest, EveryCutOrBitOfAnEncodedImageEndsWithAPictureOrAReason) {
  Image image{16, 16, {}};
  for (std::uint32_t i = 0; i < 16 * 16; ++i) {
    for (const std::uint32_t c : {8 * (i % 16), 8 * (i / 16), 128U, 255U}) {
      image.rgba.push_back(static_cast<std::uint8_t>(c));
    }
  }
  ASSERT_TRUE(write_png(image, folder_ / "a.png").ok());
  const std::string to_jpeg = "ffmpeg -v error -y -i " + (folder_ / "a.png").string() + " -q:v 1 " +
                              (folder_ / "a.jpg").string();
  ASSERT_EQ(std::system(to_jpeg.c_str()), 0);  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  for (const char* name : {"a.png", "a.jpg"}) {
    std::ifstream stream(folder_ / name, std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream), {}};
    const Result<Image> read = decode_image(bytes, 16);
    ASSERT_TRUE(read.ok()) << name << ": " << read.error().text;
    ASSERT_EQ(read.value().rgba.size(), image.rgba.size());
    int worst = 0;
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
      worst = std::max(worst, std::abs(image.rgba[i] - read.value().rgba[i]));
    }
    EXPECT_LE(worst, name == std::string("a.png") ? 0 : 12);  // JPEG halves the colours' resolution
    const Result<Image> small = decode_image(bytes, 15);
    ASSERT_FALSE(small.ok());
    EXPECT_EQ(small.error().text, "it is 16x16 pixels; each side may be 1 to 15");
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      // Of a cut file that still has all of its pixels, it is the same picture.
      const Result<Image> cut = decode_image({bytes.data(), length}, 16);
      EXPECT_TRUE(!cut || cut.value() == read.value()) << name << ' ' << length;
      EXPECT_TRUE(!cut || length + 20 > bytes.size()) << name << ' ' << length;
      std::vector<unsigned char> damaged = bytes;
      damaged[length] ^= 0x15U;
      (void)decode_image(damaged, 64);
    }
  }
  EXPECT_EQ(decode_image({}, 16).error().text, "its file is missing or empty");
  const std::vector<unsigned char> other = {'G', 'I', 'F'};
  EXPECT_NE(decode_image(other, 16).error().text.find("neither a PNG nor a JPEG"),
            std::string::npos);
}

}  // namespace
}  // namespace torsion::engine
