#pragma once

#include <cstdint>

#include "render/vk.hpp"

namespace torsion::engine {

/// One picture under way.
struct Frame {
  std::uint32_t slot = 0;                             // which of the frames in flight
  const vk::raii::CommandBuffer* commands = nullptr;  // being recorded
  vk::Image image;  // to draw or resolve into, of Target::format()
  vk::ImageView view;
  vk::Extent2D extent;
};

/// Where pictures go: owns their images and the frames in flight, so that the renderer knows
/// neither of windows nor of files.
class Target {
 public:
  Target() = default;
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  Target(Target&&) = delete;
  Target& operator=(Target&&) = delete;
  virtual ~Target() = default;

  /// Waits until the frame before in the same slot is done, and begins its commands.
  virtual Frame begin() = 0;

  /// Records what hands the finished picture on. The image is a colour attachment, fully drawn.
  virtual void finish(const Frame& frame) = 0;

  /// Ends the commands and gives them to the device.
  virtual void submit(const Frame& frame) = 0;

  [[nodiscard]] virtual vk::Format format() const = 0;
  [[nodiscard]] virtual vk::Extent2D extent() const = 0;
};

}  // namespace torsion::engine
