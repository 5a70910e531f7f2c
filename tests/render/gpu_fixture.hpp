#pragma once

#include <gtest/gtest.h>

#include "render/renderer.hpp"

namespace torsion::engine {

/// Switches synchronization validation on across submits too, which the layer of Debian 12 leaves
/// off: without it nothing between two frames is looked at. Before the first Vulkan instance.
void validate_across_submits();

/// A test of what runs on a device, under validation: any message of the layers fails it.
class GpuTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { validate_across_submits(); }

  void TearDown() override {
    for (const std::string& message : log_.messages) {
      ADD_FAILURE() << message;
    }
  }

  /// Options of a small picture with validation on.
  [[nodiscard]] RendererOptions options(std::uint32_t width = 96, std::uint32_t height = 64) {
    RendererOptions options;
    options.width = width;
    options.height = height;
    options.validation = &log_;
    return options;
  }

  /// Opens a renderer, or throws what went wrong, which fails the test.
  static Renderer open(const RendererOptions& options, const FrameWorld& frame);

 private:
  ValidationLog log_;  // lives longer than the renderers, which a test makes
};

/// The value, or an exception with the error's text, which fails the test.
template <class T>
T must(Result<T> result) {
  if (!result) {
    throw std::runtime_error(result.error().text);
  }
  return std::move(result).value();
}

}  // namespace torsion::engine
