#pragma once

// Every dependency between passes, by name. No other barrier is recorded anywhere: synchronization
// validation of Debian 12 does not see a missing one after a rendering pass, and lavapipe draws the
// right picture without any, so this list is short enough to be checked by reading.

#include "render/vk.hpp"

namespace torsion {

namespace detail {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

inline void memory_barrier(const vk::raii::CommandBuffer& commands,
                           const vk::MemoryBarrier2& barrier) {
  commands.pipelineBarrier2(
      vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
}

inline void image_barrier(const vk::raii::CommandBuffer& commands, vk::Image image,
                          vk::ImageAspectFlags aspect, vk::ImageMemoryBarrier2 barrier) {
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = vk::ImageSubresourceRange{aspect, 0, 1, 0, 1};
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
                               .dstAccessMask = Access::eShaderStorageRead | Access::eUniformRead |
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
                               .dstAccessMask = Access::eShaderStorageRead,
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
  image_barrier(commands, image, vk::ImageAspectFlagBits::eDepth,
                {
                    .srcStageMask = Stage::eFragmentShader,
                    .dstStageMask = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                    .dstAccessMask =
                        Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite,
                    .oldLayout = vk::ImageLayout::eUndefined,
                    .newLayout = vk::ImageLayout::eDepthAttachmentOptimal,
                });
}

/// The shadow map, before this frame's fragments sample it.
inline void shadow_target_to_sampled(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eDepth,
                {
                    .srcStageMask = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                    .srcAccessMask = Access::eDepthStencilAttachmentWrite,
                    .dstStageMask = Stage::eFragmentShader,
                    .dstAccessMask = Access::eShaderSampledRead,
                    .oldLayout = vk::ImageLayout::eDepthAttachmentOptimal,
                    .newLayout = vk::ImageLayout::eShaderReadOnlyOptimal,
                });
}

/// The depth image to be drawn anew, after the last frame's tests wrote it.
inline void to_depth_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eDepth,
                {
                    .srcStageMask = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                    .srcAccessMask = Access::eDepthStencilAttachmentWrite,
                    .dstStageMask = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                    .dstAccessMask =
                        Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite,
                    .oldLayout = vk::ImageLayout::eUndefined,
                    .newLayout = vk::ImageLayout::eDepthAttachmentOptimal,
                });
}

/// A colour image to be drawn anew, after it was last drawn to, resolved into, or copied or
/// stretched from.
inline void to_color_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eColorAttachmentOutput | Stage::eCopy | Stage::eBlit,
                    .srcAccessMask = Access::eColorAttachmentWrite,
                    .dstStageMask = Stage::eColorAttachmentOutput,
                    .dstAccessMask = Access::eColorAttachmentRead | Access::eColorAttachmentWrite,
                    .oldLayout = vk::ImageLayout::eUndefined,
                    .newLayout = vk::ImageLayout::eColorAttachmentOptimal,
                });
}

/// The finished picture, before it is copied to the read-back buffer.
inline void color_target_to_copy_source(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eColorAttachmentOutput,
                    .srcAccessMask = Access::eColorAttachmentWrite,
                    .dstStageMask = Stage::eCopy,
                    .dstAccessMask = Access::eTransferRead,
                    .oldLayout = vk::ImageLayout::eColorAttachmentOptimal,
                    .newLayout = vk::ImageLayout::eTransferSrcOptimal,
                });
}

/// The finished picture of the scene, before it is stretched into the window's image.
inline void color_target_to_blit_source(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eColorAttachmentOutput,
                    .srcAccessMask = Access::eColorAttachmentWrite,
                    .dstStageMask = Stage::eBlit | Stage::eCopy,
                    .dstAccessMask = Access::eTransferRead,
                    .oldLayout = vk::ImageLayout::eColorAttachmentOptimal,
                    .newLayout = vk::ImageLayout::eTransferSrcOptimal,
                });
}

/// The window's image, acquired, before the scene is stretched into it: what was on it is gone. The
/// wait for its semaphore is at the same stage.
inline void acquired_to_blit_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eBlit | Stage::eCopy,
                    .dstStageMask = Stage::eBlit | Stage::eCopy,
                    .dstAccessMask = Access::eTransferWrite,
                    .oldLayout = vk::ImageLayout::eUndefined,
                    .newLayout = vk::ImageLayout::eTransferDstOptimal,
                });
}

/// The window's image with the scene on it, before the overlay is drawn over that.
inline void copy_target_to_color_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eBlit | Stage::eCopy,
                    .srcAccessMask = Access::eTransferWrite,
                    .dstStageMask = Stage::eColorAttachmentOutput,
                    .dstAccessMask = Access::eColorAttachmentRead | Access::eColorAttachmentWrite,
                    .oldLayout = vk::ImageLayout::eTransferDstOptimal,
                    .newLayout = vk::ImageLayout::eColorAttachmentOptimal,
                });
}

/// The window's image with scene and marks on it, before panels are copied over that.
inline void color_target_to_copy_target(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eColorAttachmentOutput,
                    .srcAccessMask = Access::eColorAttachmentWrite,
                    .dstStageMask = Stage::eCopy,
                    .dstAccessMask = Access::eTransferWrite,
                    .oldLayout = vk::ImageLayout::eColorAttachmentOptimal,
                    .newLayout = vk::ImageLayout::eTransferDstOptimal,
                });
}

/// The window's image, copied for a screenshot, before it is shown. The semaphore does the rest.
inline void copy_source_to_present(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eCopy,
                    .dstStageMask = Stage::eNone,
                    .oldLayout = vk::ImageLayout::eTransferSrcOptimal,
                    .newLayout = vk::ImageLayout::ePresentSrcKHR,
                });
}

/// The window's finished image, before it is shown. The semaphore does the rest.
inline void color_target_to_present(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eColorAttachmentOutput,
                    .srcAccessMask = Access::eColorAttachmentWrite,
                    .dstStageMask = Stage::eNone,
                    .oldLayout = vk::ImageLayout::eColorAttachmentOptimal,
                    .newLayout = vk::ImageLayout::ePresentSrcKHR,
                });
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
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eNone,
                    .dstStageMask = Stage::eCopy,
                    .dstAccessMask = Access::eTransferWrite,
                    .oldLayout = vk::ImageLayout::eUndefined,
                    .newLayout = vk::ImageLayout::eTransferDstOptimal,
                });
}

/// Texels that were copied in, before fragments sample them.
inline void copy_target_to_sampled(const vk::raii::CommandBuffer& commands, vk::Image image) {
  using namespace detail;
  image_barrier(commands, image, vk::ImageAspectFlagBits::eColor,
                {
                    .srcStageMask = Stage::eCopy,
                    .srcAccessMask = Access::eTransferWrite,
                    .dstStageMask = Stage::eFragmentShader,
                    .dstAccessMask = Access::eShaderSampledRead,
                    .oldLayout = vk::ImageLayout::eTransferDstOptimal,
                    .newLayout = vk::ImageLayout::eShaderReadOnlyOptimal,
                });
}

}  // namespace torsion
