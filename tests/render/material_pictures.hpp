#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "tests/render/gpu_fixture.hpp"
#include "tests/render/render_scenes.hpp"

namespace torsion::engine {

struct Color {
  int r, g, b;
};

/// Each part within `tolerance`.
void expect_near(const Color& color, const Color& expected, int tolerance);

/// A test that draws surfaces without marks and looks at pixels.
class MaterialPictures : public GpuTest {
 protected:
  /// An image as a file has it.
  static std::shared_ptr<const EncodedImage> encoded(const Image& image);

  /// Of one colour.
  static Image plain(const std::array<std::uint8_t, 4>& rgba);

  Image draw(const FrameWorld& frame, const Camera& camera, ToolLook look = ToolLook::kAuthored,
             std::optional<bool> quick = std::nullopt);

  /// @param x, y  0 to 1 from the top left corner
  static Color at(const Image& image, double x, double y);

  static int sum(const Color& color) { return color.r + color.g + color.b; }

  /// A slab that fills the picture, seen from above, +x to the right.
  static FrameWorld slab();
  static Camera above() { return camera_at({0.0, 0.3, 1e-4}, glm::dvec3(0.0), 0.3); }

  /// Lays a texture over the slab as that is seen from above.
  static void spread_texture(FrameWorld& frame);

  /// A box and a ball beside it whose shadow falls on the floor, where neither is in the picture.
  static FrameWorld shadow_scene();
  static Camera shadow_camera();
};

}  // namespace torsion::engine
