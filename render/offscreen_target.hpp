#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/memory.hpp"
#include "render/target.hpp"

namespace torsion::engine {

/// Pictures into memory: each slot has an image, a buffer to read it back, and a fence.
class OffscreenTarget final : public Target {
 public:
  /// @param gpu  must outlive the target
  OffscreenTarget(const Gpu& gpu, vk::Extent2D extent, std::uint32_t slots);

  Frame begin() override;
  void finish(const Frame& frame) override;
  void submit(const Frame& frame) override;
  [[nodiscard]] vk::Format format() const override { return vk::Format::eR8G8B8A8Srgb; }
  [[nodiscard]] vk::Extent2D extent() const override { return extent_; }

  /// Waits until the last frame of `slot` is done.
  void wait(std::uint32_t slot);

  /// Its pixels, RGBA bytes, rows from the top; valid until the slot's next begin(). Waits as
  /// wait() does.
  std::span<const std::byte> pixels(std::uint32_t slot);

 private:
  struct Slot {
    Image2d image;
    Buffer read_back;
    vk::raii::CommandPool pool = nullptr;
    vk::raii::CommandBuffers commands = nullptr;
    vk::raii::Fence done = nullptr;
  };

  const Gpu* gpu_;
  vk::Extent2D extent_;
  std::vector<Slot> slots_;
  std::uint32_t next_ = 0;
};

}  // namespace torsion::engine
