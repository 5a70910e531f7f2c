#include "render/memory.hpp"

#include <algorithm>
#include <cstring>

#include "ecs/assert.hpp"
#include "render/barriers.hpp"

namespace torsion::engine {
namespace {

using Flag = vk::MemoryPropertyFlagBits;

/// The first type among `allowed` that has the required flags and, if there is one, the preferred
/// ones too.
std::uint32_t memory_type(const Gpu& gpu, std::uint32_t allowed, vk::MemoryPropertyFlags required,
                          vk::MemoryPropertyFlags preferred) {
  for (const vk::MemoryPropertyFlags wanted : {required | preferred, required}) {
    for (std::uint32_t type = 0; type < gpu.memory.memoryTypeCount; ++type) {
      const bool is_allowed = (allowed & (1U << type)) != 0;
      if (is_allowed && (gpu.memory.memoryTypes[type].propertyFlags & wanted) == wanted) {
        return type;
      }
    }
  }
  throw vk::OutOfDeviceMemoryError("no memory type that is " + vk::to_string(required));
}

vk::raii::DeviceMemory allocate(const Gpu& gpu, const vk::MemoryRequirements& needs,
                                vk::MemoryPropertyFlags required,
                                vk::MemoryPropertyFlags preferred) {
  return {gpu.device,
          vk::MemoryAllocateInfo{
              .allocationSize = needs.size,
              .memoryTypeIndex = memory_type(gpu, needs.memoryTypeBits, required, preferred),
          }};
}

vk::ImageAspectFlags aspect_of(vk::Format format) {
  return format == vk::Format::eD32Sfloat ? vk::ImageAspectFlagBits::eDepth
                                          : vk::ImageAspectFlagBits::eColor;
}

}  // namespace

Buffer make_buffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, Home home) {
  constexpr vk::DeviceSize kSmallest = 16;
  Buffer buffer;
  buffer.size = std::max(size, kSmallest);
  buffer.handle = {gpu.device, vk::BufferCreateInfo{.size = buffer.size, .usage = usage}};
  vk::MemoryPropertyFlags required = Flag::eHostVisible | Flag::eHostCoherent;
  vk::MemoryPropertyFlags preferred;
  bool mapped = true;
  if (home == Home::kDevice) {
    mapped = gpu.writes_device_memory;
    required = mapped ? required | Flag::eDeviceLocal : Flag::eDeviceLocal;
  } else if (home == Home::kReadBack) {
    preferred = Flag::eHostCached;
  }
  buffer.memory = allocate(gpu, buffer.handle.getMemoryRequirements(), required, preferred);
  buffer.handle.bindMemory(*buffer.memory, 0);
  if (mapped) {
    buffer.mapped = static_cast<std::byte*>(buffer.memory.mapMemory(0, VK_WHOLE_SIZE));
  }
  return buffer;
}

namespace {

Image2d make_viewed_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                          vk::Format view_format, vk::SampleCountFlagBits samples,
                          vk::ImageUsageFlags usage, std::uint32_t levels = 1) {
  const vk::ImageCreateFlags flags =
      format == view_format ? vk::ImageCreateFlags{} : vk::ImageCreateFlagBits::eMutableFormat;
  Image2d image;
  image.extent = extent;
  image.handle = {gpu.device, vk::ImageCreateInfo{
                                  .flags = flags,
                                  .imageType = vk::ImageType::e2D,
                                  .format = format,
                                  .extent = {extent.width, extent.height, 1},
                                  .mipLevels = levels,
                                  .arrayLayers = 1,
                                  .samples = samples,
                                  .usage = usage,
                              }};
  image.memory = allocate(gpu, image.handle.getMemoryRequirements(), Flag::eDeviceLocal, {});
  image.handle.bindMemory(*image.memory, 0);
  image.view = {gpu.device, vk::ImageViewCreateInfo{
                                .image = *image.handle,
                                .viewType = vk::ImageViewType::e2D,
                                .format = view_format,
                                .subresourceRange = {aspect_of(format), 0, levels, 0, 1},
                            }};
  return image;
}

}  // namespace

Image2d make_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                   vk::SampleCountFlagBits samples, vk::ImageUsageFlags usage) {
  return make_viewed_image(gpu, extent, format, format, samples, usage);
}

Image2d make_encoded_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                           vk::Format view_format, vk::ImageUsageFlags usage) {
  return make_viewed_image(gpu, extent, format, view_format, vk::SampleCountFlagBits::e1, usage);
}

Buffer make_constant_buffer(const Gpu& gpu, std::span<const std::byte> bytes,
                            vk::BufferUsageFlags usage) {
  Buffer buffer =
      make_buffer(gpu, bytes.size(), usage | vk::BufferUsageFlagBits::eTransferDst, Home::kDevice);
  if (bytes.empty()) {
    return buffer;
  }
  if (buffer.mapped != nullptr) {
    std::memcpy(buffer.mapped, bytes.data(), bytes.size());
    return buffer;
  }
  const Buffer staging =
      make_buffer(gpu, bytes.size(), vk::BufferUsageFlagBits::eTransferSrc, Home::kUpload);
  std::memcpy(staging.mapped, bytes.data(), bytes.size());
  run_once(gpu, [&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(*staging.handle, *buffer.handle, vk::BufferCopy{.size = bytes.size()});
  });
  return buffer;
}

Image2d make_constant_image(const Gpu& gpu, vk::Extent2D extent, vk::Format format,
                            std::span<const std::span<const std::byte>> levels) {
  Image2d image =
      make_viewed_image(gpu, extent, format, format, vk::SampleCountFlagBits::e1,
                        vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst,
                        static_cast<std::uint32_t>(levels.size()));
  std::vector<vk::BufferImageCopy> copies;
  vk::DeviceSize size = 0;
  for (std::uint32_t level = 0; level < levels.size(); ++level) {
    copies.push_back({
        .bufferOffset = size,
        .imageSubresource = {vk::ImageAspectFlagBits::eColor, level, 0, 1},
        .imageExtent = {std::max(extent.width >> level, 1U), std::max(extent.height >> level, 1U),
                        1},
    });
    size += levels[level].size();
  }
  const Buffer staging =
      make_buffer(gpu, size, vk::BufferUsageFlagBits::eTransferSrc, Home::kUpload);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    std::ranges::copy(levels[level], staging.mapped + copies[level].bufferOffset);
  }
  run_once(gpu, [&](const vk::raii::CommandBuffer& commands) {
    new_to_copy_target(commands, *image.handle);
    commands.copyBufferToImage(*staging.handle, *image.handle, vk::ImageLayout::eTransferDstOptimal,
                               copies);
    copy_target_to_sampled(commands, *image.handle);
  });
  return image;
}

FrameBuffer::FrameBuffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage)
    : usage_(usage) {
  reserve(gpu, size);
}

void FrameBuffer::write(vk::DeviceSize offset, std::span<const std::byte> bytes) {
  TORSION_ASSERT(offset + bytes.size() <= device_.size);
  if (bytes.empty()) {
    return;
  }
  const bool staged = device_.mapped == nullptr;
  std::memcpy((staged ? staging_.mapped : device_.mapped) + offset, bytes.data(), bytes.size());
  if (staged) {
    written_.push_back({.srcOffset = offset, .dstOffset = offset, .size = bytes.size()});
  }
}

void FrameBuffer::reserve(const Gpu& gpu, vk::DeviceSize size) {
  if (device_.size >= size && device_.size > 0) {
    return;
  }
  // Half as much again, so that a slowly growing overlay does not end in a new buffer every frame.
  const vk::DeviceSize rounded = device_.size == 0 ? size : size + size / 2;
  device_ =
      make_buffer(gpu, rounded, usage_ | vk::BufferUsageFlagBits::eTransferDst, Home::kDevice);
  if (device_.mapped == nullptr) {
    staging_ = make_buffer(gpu, rounded, vk::BufferUsageFlagBits::eTransferSrc, Home::kUpload);
  }
  written_.clear();
}

bool FrameBuffer::record_copies(const vk::raii::CommandBuffer& commands) {
  if (written_.empty()) {
    return false;
  }
  commands.copyBuffer(*staging_.handle, *device_.handle, written_);
  written_.clear();
  return true;
}

}  // namespace torsion::engine
