#include "render/offscreen_target.hpp"

#include <utility>

#include "render/barriers.hpp"

namespace torsion::engine {

OffscreenTarget::OffscreenTarget(const Gpu& gpu, vk::Extent2D extent, std::uint32_t slots)
    : gpu_(&gpu), extent_(extent) {
  const vk::DeviceSize bytes = vk::DeviceSize{4} * extent.width * extent.height;
  for (std::uint32_t i = 0; i < slots; ++i) {
    Slot slot;
    slot.image =
        make_image(gpu, extent, format(), vk::SampleCountFlagBits::e1,
                   vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferSrc);
    slot.read_back =
        make_buffer(gpu, bytes, vk::BufferUsageFlagBits::eTransferDst, Home::kReadBack);
    slot.pool = {gpu.device, vk::CommandPoolCreateInfo{.queueFamilyIndex = gpu.queue_family}};
    slot.commands = {gpu.device, vk::CommandBufferAllocateInfo{.commandPool = *slot.pool,
                                                               .commandBufferCount = 1}};
    // Signalled, so that the first frame does not wait.
    slot.done = {gpu.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled}};
    slots_.push_back(std::move(slot));
  }
}

Frame OffscreenTarget::begin() {
  const std::uint32_t index = next_;
  next_ = (next_ + 1) % static_cast<std::uint32_t>(slots_.size());
  wait(index);
  const Slot& slot = slots_[index];
  slot.pool.reset();
  const vk::raii::CommandBuffer& commands = slot.commands.front();
  commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  return {index, &commands, *slot.image.handle, *slot.image.view, extent_};
}

void OffscreenTarget::finish(const Frame& frame) {
  const Slot& slot = slots_[frame.slot];
  color_target_to_copy_source(*frame.commands, frame.image);
  frame.commands->copyImageToBuffer(
      frame.image, vk::ImageLayout::eTransferSrcOptimal, *slot.read_back.handle,
      vk::BufferImageCopy{
          .imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
          .imageExtent = {extent_.width, extent_.height, 1},
      });
  copy_to_host(*frame.commands);
}

void OffscreenTarget::submit(const Frame& frame) {
  const Slot& slot = slots_[frame.slot];
  frame.commands->end();
  gpu_->device.resetFences(*slot.done);
  const vk::CommandBufferSubmitInfo submitted{.commandBuffer = **frame.commands};
  gpu_->queue.submit2(
      vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted}, *slot.done);
}

void OffscreenTarget::wait(std::uint32_t slot) {
  constexpr bool kAll = true;
  const vk::Result result = gpu_->device.waitForFences(*slots_[slot].done, kAll, UINT64_MAX);
  if (result != vk::Result::eSuccess) {
    throw vk::SystemError(vk::make_error_code(result), "waiting for a frame");
  }
}

std::span<const std::byte> OffscreenTarget::pixels(std::uint32_t slot) {
  wait(slot);
  const Buffer& buffer = slots_[slot].read_back;
  return {buffer.mapped, buffer.size};
}

}  // namespace torsion::engine
