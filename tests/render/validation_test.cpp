// Plants the errors that the other tests must not have: if the layers stay silent here, their
// silence there means nothing.

#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "render/barriers.hpp"
#include "render/memory.hpp"
#include "tests/render/gpu_fixture.hpp"

namespace torsion::engine {
namespace {

using Usage = vk::BufferUsageFlagBits;

/// Not a GpuTest: these want messages.
class ValidationTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { validate_across_submits(); }

  [[nodiscard]] bool said(std::string_view name) const {
    return std::ranges::any_of(log_.messages, [&](const std::string& message) {
      return message.find(name) != std::string::npos;
    });
  }

  ValidationLog log_;
  Gpu gpu_ = must(open_gpu({&log_, false, "", {}}));
};

class ThreeBuffers {
 public:
  explicit ThreeBuffers(const Gpu& gpu)
      : first_(make(gpu)), second_(make(gpu)), third_(make(gpu)) {}

  void copy_to_second(const vk::raii::CommandBuffer& commands) const {
    commands.copyBuffer(*first_.handle, *second_.handle, vk::BufferCopy{.size = kSize});
  }
  void copy_to_third(const vk::raii::CommandBuffer& commands) const {
    commands.copyBuffer(*second_.handle, *third_.handle, vk::BufferCopy{.size = kSize});
  }

 private:
  static constexpr vk::DeviceSize kSize = 64;
  static Buffer make(const Gpu& gpu) {
    return make_buffer(gpu, kSize, Usage::eTransferSrc | Usage::eTransferDst, Home::kUpload);
  }
  Buffer first_;
  Buffer second_;
  Buffer third_;
};

TEST_F(ValidationTest, ReportsAMissingLayoutTransition) {
  const Image2d image =
      make_image(gpu_, {4, 4}, vk::Format::eR8G8B8A8Unorm, vk::SampleCountFlagBits::e1,
                 vk::ImageUsageFlagBits::eTransferDst);
  run_once(gpu_, [&](const vk::raii::CommandBuffer& commands) {
    commands.clearColorImage(
        *image.handle, vk::ImageLayout::eTransferDstOptimal, vk::ClearColorValue{},
        vk::ImageSubresourceRange{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
  });
  EXPECT_TRUE(said("VUID-vkCmdDraw-None-09600") || said("UNASSIGNED-CoreValidation-DrawState"))
      << (log_.messages.empty() ? "silent" : log_.messages.front());
}

TEST_F(ValidationTest, ReportsAMissingBarrierInOneSubmit) {
  const ThreeBuffers buffers(gpu_);
  run_once(gpu_, [&](const vk::raii::CommandBuffer& commands) {
    buffers.copy_to_second(commands);
    buffers.copy_to_third(commands);
  });
  EXPECT_TRUE(said("SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST_F(ValidationTest, ReportsAMissingBarrierBetweenSubmits) {
  const ThreeBuffers buffers(gpu_);
  const vk::raii::CommandPool pool(
      gpu_.device, vk::CommandPoolCreateInfo{.queueFamilyIndex = gpu_.queue_family});
  const vk::raii::CommandBuffers commands(
      gpu_.device, vk::CommandBufferAllocateInfo{.commandPool = *pool, .commandBufferCount = 2});
  commands[0].begin(vk::CommandBufferBeginInfo{});
  buffers.copy_to_second(commands[0]);
  commands[0].end();
  commands[1].begin(vk::CommandBufferBeginInfo{});
  buffers.copy_to_third(commands[1]);
  commands[1].end();
  for (const vk::raii::CommandBuffer& recorded : commands) {
    const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *recorded};
    gpu_.queue.submit2(
        vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted});
  }
  gpu_.queue.waitIdle();
  EXPECT_TRUE(said("SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST_F(ValidationTest, IsSilentWhereTheBarriersAre) {
  const ThreeBuffers buffers(gpu_);
  run_once(gpu_, [&](const vk::raii::CommandBuffer& commands) {
    buffers.copy_to_second(commands);
    detail::memory_barrier(commands, {.srcStageMask = vk::PipelineStageFlagBits2::eCopy,
                                      .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                      .dstStageMask = vk::PipelineStageFlagBits2::eCopy,
                                      .dstAccessMask = vk::AccessFlagBits2::eTransferRead});
    buffers.copy_to_third(commands);
  });
  EXPECT_TRUE(log_.messages.empty()) << log_.messages.front();
}

}  // namespace
}  // namespace torsion::engine
