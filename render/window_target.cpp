#include "render/window_target.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "render/barriers.hpp"

namespace torsion::engine {
namespace {

using Usage = vk::ImageUsageFlagBits;

constexpr std::uint64_t kLongestWait = 2'000'000'000;  // ns: for an image of the window

[[noreturn]] void fail(vk::Result result, const char* doing) {
  throw vk::SystemError(vk::make_error_code(result), doing);
}

/// Eight bits of encoded sRGB, kept as they are written: the scene is encoded when it is drawn into
/// its own image, and stretching and blending encoded bytes costs a processor a third.
vk::SurfaceFormatKHR choose_format(const std::vector<vk::SurfaceFormatKHR>& formats) {
  for (const vk::Format wanted : {vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm}) {
    for (const vk::SurfaceFormatKHR& format : formats) {
      if (format.format == wanted && format.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear) {
        return format;
      }
    }
  }
  fail(vk::Result::eErrorFormatNotSupported, "choosing the format of a window (8 bits, sRGB)");
}

std::uint32_t side(std::uint32_t outer, double share) {
  return std::max(1U, static_cast<std::uint32_t>(std::lround(outer * share)));
}

}  // namespace

std::vector<std::string> surface_extensions() {
  std::uint32_t count = 0;
  const char** const names = ::glfwGetRequiredInstanceExtensions(&count);
  return {names, names + count};
}

WindowTarget::WindowTarget(const Gpu& gpu, const Window& window, std::uint32_t slots)
    : gpu_(&gpu), window_(&window) {
  make_surface();
  for (std::uint32_t i = 0; i < slots; ++i) {
    Slot slot;
    slot.pool = {gpu.device, vk::CommandPoolCreateInfo{.queueFamilyIndex = gpu.queue_family}};
    slot.commands = {gpu.device, vk::CommandBufferAllocateInfo{.commandPool = *slot.pool,
                                                               .commandBufferCount = 1}};
    slot.done = {gpu.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled}};
    slot.acquired = {gpu.device, vk::SemaphoreCreateInfo{}};
    slots_.push_back(std::move(slot));
  }
}

WindowTarget::~WindowTarget() {
  // Images and semaphores may still be in use. Not by the member function, which throws.
  gpu_->device.getDispatcher()->vkDeviceWaitIdle(static_cast<VkDevice>(*gpu_->device));
}

void WindowTarget::make_surface() {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result =
      ::glfwCreateWindowSurface(static_cast<VkInstance>(*gpu_->instance),
                                static_cast<GLFWwindow*>(window_->handle()), nullptr, &surface);
  if (result != VK_SUCCESS) {
    fail(static_cast<vk::Result>(result), "making a window's surface");
  }
  surface_ = vk::raii::SurfaceKHR(gpu_->instance, surface);
  if (gpu_->physical.getSurfaceSupportKHR(gpu_->queue_family, *surface_) == VK_FALSE) {
    fail(vk::Result::eErrorFeatureNotPresent, "asking whether the device can show in windows");
  }
  surface_format_ = choose_format(gpu_->physical.getSurfaceFormatsKHR(*surface_));
  surface_lost_ = false;
}

void WindowTarget::make_swapchain(std::uint32_t width, std::uint32_t height) {
  gpu_->device.waitIdle();
  const vk::SurfaceCapabilitiesKHR can = gpu_->physical.getSurfaceCapabilitiesKHR(*surface_);
  outer_ = can.currentExtent;
  if (outer_.width == UINT32_MAX) {  // the surface takes what the swapchain has
    outer_ = vk::Extent2D{std::clamp(width, can.minImageExtent.width, can.maxImageExtent.width),
                          std::clamp(height, can.minImageExtent.height, can.maxImageExtent.height)};
  }
  if (outer_.width == 0 || outer_.height == 0) {
    return;
  }
  const std::uint32_t wanted = std::max(3U, can.minImageCount);
  const vk::raii::SwapchainKHR old = std::move(swapchain_);
  swapchain_ = {
      gpu_->device,
      vk::SwapchainCreateInfoKHR{
          .surface = *surface_,
          .minImageCount = can.maxImageCount == 0 ? wanted : std::min(wanted, can.maxImageCount),
          .imageFormat = surface_format_.format,
          .imageColorSpace = surface_format_.colorSpace,
          .imageExtent = outer_,
          .imageArrayLayers = 1,
          .imageUsage = Usage::eColorAttachment | Usage::eTransferDst | Usage::eTransferSrc,
          .imageSharingMode = vk::SharingMode::eExclusive,
          .preTransform = can.currentTransform,
          .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
          .presentMode = vk::PresentModeKHR::eFifo,
          .clipped = VK_TRUE,
          .oldSwapchain = *old,
      }};
  shown_.clear();
  for (const VkImage image : swapchain_.getImages()) {
    Shown shown;
    shown.image = image;
    shown.view = {gpu_->device,
                  vk::ImageViewCreateInfo{
                      .image = shown.image,
                      .viewType = vk::ImageViewType::e2D,
                      .format = surface_format_.format,
                      .subresourceRange = {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1},
                  }};
    shown.drawn = {gpu_->device, vk::SemaphoreCreateInfo{}};
    shown_.push_back(std::move(shown));
  }
  panels_ = make_image(*gpu_, outer_, surface_format_.format, vk::SampleCountFlagBits::e1,
                       Usage::eColorAttachment | Usage::eTransferSrc);
  has_panels_ = false;
  kept_slot_.reset();
  kept_ = make_buffer(*gpu_, vk::DeviceSize{4} * outer_.width * outer_.height,
                      vk::BufferUsageFlagBits::eTransferDst, Home::kReadBack);
  stale_ = false;
}

void WindowTarget::make_inner(double share) {
  const vk::Extent2D wanted{side(outer_.width, share), side(outer_.height, share)};
  if (wanted == inner_) {
    return;
  }
  gpu_->device.waitIdle();
  inner_ = wanted;
  for (Slot& slot : slots_) {
    slot.image = make_encoded_image(*gpu_, inner_, window_format(), format(),
                                    Usage::eColorAttachment | Usage::eTransferSrc);
  }
}

bool WindowTarget::fit(std::uint32_t width, std::uint32_t height, double share) try {
  if (width == 0 || height == 0) {
    return false;
  }
  if (surface_lost_) {
    gpu_->device.waitIdle();
    shown_.clear();
    swapchain_ = nullptr;
    surface_ = nullptr;
    stale_ = true;
    make_surface();
  }
  if (stale_ || width != outer_.width || height != outer_.height) {
    make_swapchain(width, height);
    if (outer_.width == 0 || outer_.height == 0) {
      stale_ = true;
      return false;
    }
  }
  make_inner(share);
  return true;
} catch (const vk::SurfaceLostKHRError&) {
  surface_lost_ = true;
  return false;
}

bool WindowTarget::acquire(const Slot& slot) try {
  const auto [result, index] = swapchain_.acquireNextImage(kLongestWait, *slot.acquired, nullptr);
  if (result != vk::Result::eSuccess && result != vk::Result::eSuboptimalKHR) {
    return false;
  }
  current_ = index;
  stale_ = stale_ || result == vk::Result::eSuboptimalKHR;
  return true;
} catch (const vk::OutOfDateKHRError&) {
  stale_ = true;
  return false;
} catch (const vk::SurfaceLostKHRError&) {
  surface_lost_ = true;
  return false;
}

Frame WindowTarget::begin() {
  const std::uint32_t index = next_;
  wait(index);
  const Slot& slot = slots_[index];
  if (!acquire(slot)) {
    return {};
  }
  next_ = (next_ + 1) % static_cast<std::uint32_t>(slots_.size());
  slot.pool.reset();
  const vk::raii::CommandBuffer& commands = slot.commands.front();
  commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  return {index, &commands, *slot.image.handle, *slot.image.view, inner_};
}

void WindowTarget::stretch(const Frame& frame) {
  const vk::Image window_image = shown_[current_].image;
  color_target_to_blit_source(*frame.commands, frame.image);
  acquired_to_blit_target(*frame.commands, window_image);
  // What shows of the scene, to where it shows; its edges lie under panels, so that they may be
  // rounded.
  const vk::Rect2D seen = visible();
  const auto column = [&](std::int32_t inner) {
    return static_cast<std::int32_t>(
        std::lround(static_cast<double>(inner) * outer_.width / inner_.width));
  };
  const std::int32_t end = seen.offset.x + static_cast<std::int32_t>(seen.extent.width);
  const auto height = [](vk::Extent2D extent) {
    return static_cast<std::int32_t>(extent.height);
  };
  const vk::ImageSubresourceLayers layers{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
  if (inner_ == outer_) {
    const vk::Offset3D at{seen.offset.x, 0, 0};
    frame.commands->copyImage(
        frame.image, vk::ImageLayout::eTransferSrcOptimal, window_image,
        vk::ImageLayout::eTransferDstOptimal,
        vk::ImageCopy{layers, at, layers, at, {seen.extent.width, seen.extent.height, 1}});
  } else {
    const vk::ImageBlit region{
        .srcSubresource = layers,
        .srcOffsets =
            std::array{vk::Offset3D{seen.offset.x, 0, 0}, vk::Offset3D{end, height(inner_), 1}},
        .dstSubresource = layers,
        .dstOffsets = std::array{vk::Offset3D{column(seen.offset.x), 0, 0},
                                 vk::Offset3D{column(end), height(outer_), 1}},
    };
    frame.commands->blitImage(frame.image, vk::ImageLayout::eTransferSrcOptimal, window_image,
                              vk::ImageLayout::eTransferDstOptimal, region, vk::Filter::eLinear);
  }
  copy_target_to_color_target(*frame.commands, window_image);
}

void WindowTarget::begin_panels(const Frame& frame) const {
  to_color_target(*frame.commands, *panels_.handle);
}

void WindowTarget::end_panels(const Frame& frame) {
  color_target_to_blit_source(*frame.commands, *panels_.handle);
  has_panels_ = true;
}

void WindowTarget::set_panels(std::span<const OverlayPanel> places) {
  panel_places_.clear();
  visible_from_ = 0;
  visible_to_ = outer_.width;
  constexpr vk::ImageSubresourceLayers kColor{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
  for (const OverlayPanel& place : places) {
    const auto end = [](std::int32_t from, std::uint32_t size, std::uint32_t whole) {
      return std::clamp<std::int64_t>(std::int64_t{from} + size, 0, whole);
    };
    const std::int64_t left = end(place.left, 0, outer_.width);
    const std::int64_t top = end(place.top, 0, outer_.height);
    const std::int64_t right = end(place.left, place.width, outer_.width);
    const std::int64_t bottom = end(place.top, place.height, outer_.height);
    if (right > left && bottom > top) {
      const vk::Offset3D corner{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top), 0};
      panel_places_.push_back({kColor, corner, kColor, corner,
                               vk::Extent3D{static_cast<std::uint32_t>(right - left),
                                            static_cast<std::uint32_t>(bottom - top), 1}});
    }
    if (top == 0 && bottom == outer_.height) {
      visible_from_ = left == 0 ? static_cast<std::uint32_t>(right) : visible_from_;
      visible_to_ = right == outer_.width ? static_cast<std::uint32_t>(left) : visible_to_;
    }
  }
  if (visible_from_ >= visible_to_) {  // nothing is left to see: as if all were
    visible_from_ = 0;
    visible_to_ = outer_.width;
  }
}

vk::Rect2D WindowTarget::visible() const {
  const double share = static_cast<double>(inner_.width) / outer_.width;
  const auto from = static_cast<std::uint32_t>(std::floor(visible_from_ * share));
  const auto to =
      std::min(inner_.width, static_cast<std::uint32_t>(std::ceil(visible_to_ * share)));
  return {{static_cast<std::int32_t>(from), 0}, {to - from, inner_.height}};
}

void WindowTarget::place_panels(const Frame& frame) {
  if (panel_places_.empty() || !has_panels_) {
    return;
  }
  const vk::Image window_image = shown_[current_].image;
  color_target_to_copy_target(*frame.commands, window_image);
  frame.commands->copyImage(*panels_.handle, vk::ImageLayout::eTransferSrcOptimal, window_image,
                            vk::ImageLayout::eTransferDstOptimal, panel_places_);
  copy_target_to_color_target(*frame.commands, window_image);
}

void WindowTarget::finish(const Frame& frame) {
  const vk::Image image = shown_[current_].image;
  if (!keep_) {
    color_target_to_present(*frame.commands, image);
    return;
  }
  color_target_to_copy_source(*frame.commands, image);
  frame.commands->copyImageToBuffer(
      image, vk::ImageLayout::eTransferSrcOptimal, *kept_.handle,
      vk::BufferImageCopy{
          .imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
          .imageExtent = {outer_.width, outer_.height, 1},
      });
  copy_to_host(*frame.commands);
  copy_source_to_present(*frame.commands, image);
  kept_slot_ = frame.slot;
  keep_ = false;
}

void WindowTarget::submit(const Frame& frame) try {
  const Slot& slot = slots_[frame.slot];
  frame.commands->end();
  gpu_->device.resetFences(*slot.done);
  const vk::Semaphore drawn = *shown_[current_].drawn;
  const vk::CommandBufferSubmitInfo commands{.commandBuffer = **frame.commands};
  const vk::SemaphoreSubmitInfo wait{
      .semaphore = *slot.acquired,
      .stageMask = vk::PipelineStageFlagBits2::eBlit | vk::PipelineStageFlagBits2::eCopy};
  const vk::SemaphoreSubmitInfo signal{.semaphore = drawn,
                                       .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
  gpu_->queue.submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = 1,
                                      .pWaitSemaphoreInfos = &wait,
                                      .commandBufferInfoCount = 1,
                                      .pCommandBufferInfos = &commands,
                                      .signalSemaphoreInfoCount = 1,
                                      .pSignalSemaphoreInfos = &signal},
                      *slot.done);
  const vk::SwapchainKHR swapchain = *swapchain_;
  const vk::Result result = gpu_->queue.presentKHR(vk::PresentInfoKHR{.waitSemaphoreCount = 1,
                                                                      .pWaitSemaphores = &drawn,
                                                                      .swapchainCount = 1,
                                                                      .pSwapchains = &swapchain,
                                                                      .pImageIndices = &current_});
  stale_ = stale_ || result == vk::Result::eSuboptimalKHR;
} catch (const vk::OutOfDateKHRError&) {
  stale_ = true;
} catch (const vk::SurfaceLostKHRError&) {
  surface_lost_ = true;
}

Image WindowTarget::screenshot() {
  Image image{outer_.width, outer_.height, {}};
  if (!kept_slot_) {
    return {};
  }
  wait(*kept_slot_);
  image.rgba.resize(std::size_t{4} * outer_.width * outer_.height);
  std::memcpy(image.rgba.data(), kept_.mapped, image.rgba.size());
  const bool swapped = surface_format_.format == vk::Format::eB8G8R8A8Unorm;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    if (swapped) {
      std::swap(image.rgba[i], image.rgba[i + 2]);
    }
    image.rgba[i + 3] = 255;
  }
  return image;
}

void WindowTarget::wait(std::uint32_t slot) {
  constexpr bool kAll = true;
  const vk::Result result = gpu_->device.waitForFences(*slots_[slot].done, kAll, UINT64_MAX);
  if (result != vk::Result::eSuccess) {
    fail(result, "waiting for a frame");
  }
}

}  // namespace torsion::engine
