#include "render/video.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

class VideoTest : public testing::Test {
 protected:
  VideoTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("torsion_video_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~VideoTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] bool nothing_there() const { return std::filesystem::is_empty(folder_); }

  std::filesystem::path folder_;
  Image picture_{33, 21, std::vector<std::uint8_t>(4 * 33 * 21, 90)};  // odd on purpose
};

TEST_F(VideoTest, AppearsWhenItIsFinished) {
  Result<VideoWriter> video = VideoWriter::create(folder_ / "v.mp4", 33, 21, 30.0);
  ASSERT_TRUE(video.ok()) << video.error().text;
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(video.value().add(picture_).ok());
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "v.mp4"));
  const Result<Done> done = video.value().finish();
  ASSERT_TRUE(done.ok()) << done.error().text;
  std::ifstream file(folder_ / "v.mp4", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  EXPECT_NE(bytes.find("moov"), std::string::npos);
}

TEST_F(VideoTest, LeavesNothingWhenItIsGivenUp) {
  {
    Result<VideoWriter> video = VideoWriter::create(folder_ / "v.mp4", 33, 21, 30.0);
    ASSERT_TRUE(video.ok());
    EXPECT_TRUE(video.value().add(picture_).ok());
  }
  EXPECT_TRUE(nothing_there());
}

TEST_F(VideoTest, SaysWhatFfmpegSaid) {
  Result<VideoWriter> video = VideoWriter::create(folder_ / "no" / "v.mp4", 33, 21, 30.0);
  ASSERT_TRUE(video.ok());
  // It may or may not take the picture before it stops.
  const Result<Done> added = video.value().add(picture_);
  const Result<Done> done = video.value().finish();
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().text.find("No such file"), std::string::npos) << done.error().text;
  EXPECT_TRUE(nothing_there());
}

TEST_F(VideoTest, SaysWhereFfmpegIsMissing) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  const Result<VideoWriter> video = VideoWriter::create(folder_ / "v.mp4", 32, 20, 30.0);
  ::setenv("PATH", path.c_str(), 1);
  ASSERT_FALSE(video.ok());
  EXPECT_NE(video.error().text.find("install the package ffmpeg"), std::string::npos);
}

}  // namespace
}  // namespace torsion::engine
