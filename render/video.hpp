#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "ecs/result.hpp"
#include "render/image.hpp"

namespace torsion::engine {

/// Writes pictures as an .mp4 (H.264) through ffmpeg, which runs as a process of its own and takes
/// them by a pipe. The file appears when finish() has succeeded.
class VideoWriter {
 public:
  /// @param width, height  pixels; odd sizes lose their last column or row, as H.264 needs even
  /// ones
  /// @param frames_per_second  above 0
  static Result<VideoWriter> create(const std::filesystem::path& path, std::uint32_t width,
                                    std::uint32_t height, double frames_per_second);

  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();  // without finish(): ends ffmpeg and takes away what it wrote

  /// One picture of the size given to create(). Fails when ffmpeg has ended, with what it said.
  Result<Done> add(const Image& image);

  Result<Done> finish();

 private:
  struct Encoder;
  explicit VideoWriter(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace torsion::engine
