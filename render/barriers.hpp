#pragma once

// Every dependency between passes, by name. No other barrier is recorded anywhere: synchronization
// validation of Debian 12 does not see a missing one after a rendering pass, and lavapipe draws the
// right picture without any, so this list is short enough to be checked by reading.

#include "render/vk.hpp"

namespace torsion::engine {

namespace detail {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

inline void memory_barrier(const vk::raii::CommandBuffer& commands,
                           const vk::MemoryBarrier2& barrier) {
  commands.pipelineBarrier2(
      vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
}

/// Rows of a column, as texels or from storage.
inline constexpr vk::AccessFlags2 kReadsRows =
    Access::eShaderSampledRead | Access::eShaderStorageRead;

/// What a pass does with an image: where, how, and in which layout.
struct ImageUse {
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 accesses;
  vk::ImageLayout layout = vk::ImageLayout::eUndefined;
};

inline constexpr ImageUse kDepthTarget{
    Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
    Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite,
    vk::ImageLayout::eDepthAttachmentOptimal};
inline constexpr ImageUse kColorTarget{Stage::eColorAttachmentOutput,
                                       Access::eColorAttachmentRead | Access::eColorAttachmentWrite,
                                       vk::ImageLayout::eColorAttachmentOptimal};
inline constexpr ImageUse kSampled{Stage::eFragmentShader, Access::eShaderSampledRead,
                                   vk::ImageLayout::eShaderReadOnlyOptimal};
inline constexpr ImageUse kCopySource{Stage::eCopy, Access::eTransferRead,
                                      vk::ImageLayout::eTransferSrcOptimal};
inline constexpr ImageUse kCopyTarget{Stage::eCopy, Access::eTransferWrite,
                                      vk::ImageLayout::eTransferDstOptimal};
// A scene of the window's own size is copied, else stretched.
inline constexpr ImageUse kStretchSource{Stage::eBlit | Stage::eCopy, Access::eTransferRead,
                                         vk::ImageLayout::eTransferSrcOptimal};
inline constexpr ImageUse kStretchTarget{Stage::eBlit | Stage::eCopy, Access::eTransferWrite,
                                         vk::ImageLayout::eTransferDstOptimal};
inline constexpr ImageUse kPresented{Stage::eNone, Access::eNone, vk::ImageLayout::ePresentSrcKHR};
inline constexpr ImageUse kNew{Stage::eNone, Access::eNone, vk::ImageLayout::eUndefined};

/// The same use, of whose pixels nothing is wanted any more.
constexpr ImageUse forgotten(ImageUse use) {
  use.layout = vk::ImageLayout::eUndefined;
  return use;
}

/// `next` waits for `last`, and sees what it wrote.
inline void image_barrier(const vk::raii::CommandBuffer& commands, vk::Image image,
                          const ImageUse& last, const ImageUse& next) {
  constexpr vk::AccessFlags2 kWrites =
      Access::eDepthStencilAttachmentWrite | Access::eColorAttachmentWrite | Access::eTransferWrite;
  const bool depth = static_cast<bool>((last.stages | next.stages) & Stage::eLateFragmentTests);
  const vk::ImageMemoryBarrier2 barrier{
      .srcStageMask = last.stages,
      .srcAccessMask = last.accesses & kWrites,
      .dstStageMask = next.stages,
      .dstAccessMask = next.accesses,
      .oldLayout = last.layout,
      .newLayout = next.layout,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image,
      .subresourceRange = {depth ? vk::ImageAspectFlagBits::eDepth
                                 : vk::ImageAspectFlagBits::eColor,
                           0, VK_REMAINING_MIP_LEVELS, 0, 1},
  };
  commands.pipelineBarrier2(
      vk::DependencyInfo{.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

}  // namespace detail

/// Copies from staging buffers, before anything of the frame reads them: deform.comp the columns,
/// the vertex input arrows and overlay, the shaders uniforms and contacts.
inline void copies_to_frame(const vk::raii::CommandBuffer& commands) {
  using namespace detail;
  memory_barrier(commands, {
                               .srcStageMask = Stage::eCopy,
                               .srcAccessMask = Access::eTransferWrite,
                               .dstStageMask = Stage::eComputeShader | Stage::eVertexInput |
                                               Stage::eVertexShader | Stage::eFragmentShader,
                               .dstAccessMask = kReadsRows | Access::eUniformRead |
                                                Access::eVertexAttributeRead | Access::eIndexRead,
                           });
}

/// The last frame's draws read positions and normals before this frame's compute passes write them
/// anew. Nothing to make visible: an execution dependency is enough after a read.
inline void last_frame_to_compute(const vk::raii::CommandBuffer& commands) {
  using namespace detail;
  memory_barrier(commands, {
                               .srcStageMask = Stage::eVertexInput | Stage::eComputeShader,
                               .dstStageMask = Stage::eComputeShader,
                           });
}

/// Positions, before normals.comp reads them.
inline void compute_to_compute(const vk::raii::CommandBuffer& commands) {
  using namespace detail;
  memory_barrier(commands, {
                               .srcStageMask = Stage::eComputeShader,
                               .srcAccessMask = Access::eShaderStorageWrite,
                               .dstStageMask = Stage::eComputeShader,
                               .dstAccessMask = kReadsRows,
                           });
}

/// Positions and normals, before the draws read them as vertices.
inline void compute_to_vertices(const vk::raii::CommandBuffer& commands) {
  using namespace detail;
  memory_barrier(commands, {
                               .srcStageMask = Stage::eComputeShader,
                               .srcAccessMask = Access::eShaderStorageWrite,
                               .dstStageMask = Stage::eVertexInput,
                               .dstAccessMask = Access::eVertexAttributeRead,
                           });
}

/// Positions and normals, before they are copied out for tests. The wait for an idle device came
/// before.
inline void compute_to_copy(const vk::raii::CommandBuffer& commands) {
  using namespace detail;
  memory_barrier(commands, {
                               .srcStageMask = Stage::eComputeShader,
                               .srcAccessMask = Access::eShaderStorageWrite,
                               .dstStageMask = Stage::eCopy,
                               .dstAccessMask = Access::eTransferRead,
                           });
}

/// The shadow map to be drawn anew, after the last frame's fragments sampled it.
inline void sampled_to_shadow_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, forgotten(kSampled), kDepthTarget);
}

/// The shadow map, before this frame's fragments sample it.
inline void shadow_target_to_sampled(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kDepthTarget, kSampled);
}

/// The depth image to be drawn anew, after the last frame's tests wrote it.
inline void to_depth_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, forgotten(kDepthTarget), kDepthTarget);
}

/// A colour image to be drawn anew, after it was last drawn to, resolved into, or copied or
/// stretched from.
inline void to_color_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  constexpr ImageUse kBefore{Stage::eColorAttachmentOutput | Stage::eCopy | Stage::eBlit,
                             Access::eColorAttachmentWrite};
  image_barrier(commands, image, kBefore, kColorTarget);
}

/// The finished picture, before it is copied to the read-back buffer.
inline void color_target_to_copy_source(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kColorTarget, kCopySource);
}

/// The finished picture of the scene, before it is stretched into the window's image.
inline void color_target_to_blit_source(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kColorTarget, kStretchSource);
}

/// The window's image, acquired, before the scene is stretched into it: what was on it is gone. The
/// wait for its semaphore is at the same stage.
inline void acquired_to_blit_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  constexpr ImageUse kAcquired{Stage::eBlit | Stage::eCopy, Access::eNone};
  image_barrier(commands, image, kAcquired, kStretchTarget);
}

/// The window's image with the scene on it, before the overlay is drawn over that.
inline void copy_target_to_color_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kStretchTarget, kColorTarget);
}

/// The window's image with scene and marks on it, before panels are copied over that.
inline void color_target_to_copy_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kColorTarget, kCopyTarget);
}

/// The window's image, copied for a screenshot, before it is shown. The semaphore does the rest.
inline void copy_source_to_present(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kCopySource, kPresented);
}

/// The window's finished image, before it is shown. The semaphore does the rest.
inline void color_target_to_present(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kColorTarget, kPresented);
}

/// A read-back buffer, before the CPU reads it (after the fence).
inline void copy_to_host(const vk::raii::CommandBuffer& commands) {
  using namespace detail;
  memory_barrier(commands, {
                               .srcStageMask = Stage::eCopy,
                               .srcAccessMask = Access::eTransferWrite,
                               .dstStageMask = Stage::eHost,
                               .dstAccessMask = Access::eHostRead,
                           });
}

/// A new image, before its texels are copied in.
inline void new_to_copy_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kNew, kCopyTarget);
}

/// Texels that were copied in, before fragments sample them.
inline void copy_target_to_sampled(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, kCopyTarget, kSampled);
}

}  // namespace torsion::engine
