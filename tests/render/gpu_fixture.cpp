#include "tests/render/gpu_fixture.hpp"

#include <cstdlib>

namespace torsion::engine {

void validate_across_submits() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): before any driver starts a thread
  ASSERT_EQ(setenv("VK_LAYER_ENABLES",
                   "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 1),
            0);
}

Renderer GpuTest::open(const RendererOptions& options, const FrameWorld& frame) {
  return must(Renderer::create(options, frame));
}

}  // namespace torsion::engine
