#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/gpu.hpp"

namespace torsion::engine {

/// A buffer with memory of its own. Members are in the order of creation.
struct Buffer {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Buffer handle = nullptr;
  vk::DeviceSize size = 0;
  std::byte* mapped = nullptr;  // null where the CPU cannot see it
};

/// An image with memory of its own, and a view of all of it.
struct Image2d {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Image handle = nullptr;
  vk::raii::ImageView view = nullptr;
  vk::Extent2D extent;
};

/// Where a buffer lives.
enum class Home {
  kDevice,    // device-local; mapped too where Gpu::writes_device_memory
  kUpload,    // written by the CPU, read by copies
  kReadBack,  // written by copies, read by the CPU
};

/// A buffer of at least one row of 16 bytes, so that an empty column still binds. Throws
/// vk::SystemError.
Buffer make_buffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, Home home);

/// Throws vk::SystemError.
Image2d make_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                   vk::SampleCountFlagBits samples, vk::ImageUsageFlags usage);

/// An image of one sample whose bytes have one format and whose view, for drawing, has its encoded
/// sibling. Throws vk::SystemError.
Image2d make_encoded_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                           vk::Format view_format, vk::ImageUsageFlags usage);

/// Records commands into a buffer of their own and waits until the device has done them. Load time
/// only.
template <class Record>
void run_once(const Gpu& gpu, Record&& record) {
  const vk::raii::CommandPool pool(gpu.device,
                                   vk::CommandPoolCreateInfo{.queueFamilyIndex = gpu.queue_family});
  const vk::raii::CommandBuffers buffers(
      gpu.device, vk::CommandBufferAllocateInfo{.commandPool = *pool, .commandBufferCount = 1});
  const vk::raii::CommandBuffer& commands = buffers.front();
  commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  commands.end();
  const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *commands};
  gpu.queue.submit2(
      vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted});
  gpu.queue.waitIdle();
}

/// A device buffer that holds `bytes` for good.
Buffer make_constant_buffer(const Gpu& gpu, std::span<const std::byte> bytes,
                            vk::BufferUsageFlags usage);

/// A sampled image that holds these bytes for good.
/// @param levels  mip levels, each half as large as the one before; rows from the top, tightly
/// packed
Image2d make_constant_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                            std::span<const std::span<const std::byte>> levels);

/// What the CPU rewrites every frame: mapped device memory, or a staging buffer that is copied in
/// the frame.
class FrameBuffer {
 public:
  FrameBuffer() = default;
  FrameBuffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage);

  /// Puts `bytes` at `offset`. Where there is staging, they arrive with `record_copies`.
  void write(vk::DeviceSize offset, std::span<const std::byte> bytes);

  /// Makes room for `size` bytes at least; what was written is lost. @pre the device is done with
  /// this buffer
  void reserve(const Gpu& gpu, vk::DeviceSize size);

  /// Records the copies of what was written since the last call. True if there were any.
  bool record_copies(const vk::raii::CommandBuffer& commands);

  [[nodiscard]] vk::Buffer handle() const { return *device_.handle; }
  [[nodiscard]] vk::DeviceSize size() const { return device_.size; }

 private:
  Buffer device_;
  Buffer staging_;
  vk::BufferUsageFlags usage_;
  std::vector<vk::BufferCopy> written_;
};

}  // namespace torsion::engine
