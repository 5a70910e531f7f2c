#include "render/image_io.hpp"

#include <fstream>

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

}  // namespace
}  // namespace torsion::engine
