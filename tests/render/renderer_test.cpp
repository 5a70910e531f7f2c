#include "render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "tests/render/gpu_fixture.hpp"
#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

using Pixel = std::array<int, 3>;

Pixel pixel_at(const Image& image, std::uint32_t x, std::uint32_t y) {
  const std::size_t at = 4 * (std::size_t{y} * image.width + x);
  return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

int difference(const Pixel& a, const Pixel& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// A solid patch as an atlas, and a list of one rectangle.
const OverlayAtlas kAtlas{1, 1, {255, 255, 255, 255}};
OverlayDrawList rectangle(float left, float top, float right, float bottom, std::uint32_t rgba) {
  return {{{left, top, 0.5F, 0.5F, rgba},
           {right, top, 0.5F, 0.5F, rgba},
           {right, bottom, 0.5F, 0.5F, rgba},
           {left, bottom, 0.5F, 0.5F, rgba}},
          {0, 1, 2, 0, 2, 3},
          {},
          0,
          {}};
}

class RendererTest : public GpuTest {
 protected:
  static Image picture(Renderer& renderer, const TwistedCube& scene,
                       const DrawOptions& options = {}, const OverlayDrawList* overlay = nullptr) {
    return must(renderer.read_pixels(
        must(renderer.draw(scene.frame, scene.snapshot, scene.camera, options, overlay))));
  }

  static std::string error_of(const RendererOptions& options, const FrameWorld& frame) {
    const Result<Renderer> renderer = Renderer::create(options, frame);
    return renderer ? "none" : renderer.error().text;
  }
};

TEST_F(RendererTest, EveryPathIsSilentUnderValidation) {
  const TwistedCube scene = twisted_cube(0.6, 8);
  const OverlayDrawList overlay = rectangle(2.0F, 2.0F, 20.0F, 10.0F, 0xFF00FF00U);
  for (const std::uint32_t samples : {1U, 4U}) {
    for (const bool staging : {false, true}) {
      RendererOptions with = options();
      with.samples = samples;
      with.force_staging = staging;
      with.overlay_atlas = &kAtlas;
      Renderer renderer = open(with, scene.frame);
      for (const HeatMap map : {HeatMap::kNone, HeatMap::kTwist, HeatMap::kPressure}) {
        DrawOptions draw;
        draw.heat_map = map;
        draw.tools = map == HeatMap::kTwist ? ToolLook::kOpaque : ToolLook::kGlass;
        draw.arrows = map != HeatMap::kNone;
        draw.ground = map != HeatMap::kPressure;
        // Without waiting, so that frames overlap.
        must(renderer.draw(scene.frame, scene.snapshot, scene.camera, draw, &overlay));
        must(renderer.draw(scene.frame, scene.snapshot, scene.camera, draw, nullptr));
      }
    }
  }
}

TEST_F(RendererTest, SceneWithoutBodiesOrToolsIsDrawn) {
  const FrameWorld frame = make_frame_world({}, {});
  Renderer renderer = open(options(), frame);
  const Camera camera = camera_at({0.2, 0.2, 0.3}, glm::dvec3(0.0), 0.6);
  const Image image = must(
      renderer.read_pixels(must(renderer.draw(frame, make_snapshot(0, 0), camera, {}, nullptr))));
  EXPECT_EQ(image.rgba.size(), 4U * image.width * image.height);
}

TEST_F(RendererTest, SameFrameGivesTheSameBits) {
  const TwistedCube scene = twisted_cube(0.6, 12);
  Renderer renderer = open(options(), scene.frame);
  const Image first = picture(renderer, scene);
  const Image second = picture(renderer, scene);  // from the other slot
  Renderer another = open(options(), scene.frame);
  EXPECT_EQ(first, second);
  EXPECT_EQ(first, picture(another, scene));
}

TEST_F(RendererTest, StagingDrawsTheSamePicture) {
  const TwistedCube scene = twisted_cube(-0.6, 12);
  RendererOptions staged = options();
  staged.force_staging = true;
  Renderer direct = open(options(), scene.frame);
  Renderer copies = open(staged, scene.frame);
  EXPECT_EQ(picture(direct, scene), picture(copies, scene));
}

TEST_F(RendererTest, BothFramesInFlightCanBeRead) {
  TwistedCube scene = twisted_cube(0.6, 8);
  Renderer renderer = open(options(), scene.frame);
  const Image expected_first = picture(renderer, scene);
  DrawOptions other;
  other.grid = false;
  const Image expected_second = picture(renderer, scene, other);
  ASSERT_NE(expected_first, expected_second);

  const std::uint64_t first =
      must(renderer.draw(scene.frame, scene.snapshot, scene.camera, {}, nullptr));
  const std::uint64_t second =
      must(renderer.draw(scene.frame, scene.snapshot, scene.camera, other, nullptr));
  EXPECT_EQ(second, first + 1);
  EXPECT_EQ(must(renderer.read_pixels(second)), expected_second);
  EXPECT_EQ(must(renderer.read_pixels(first)), expected_first);
}

TEST_F(RendererTest, PassTimesAreThoseOfTheFrame) {
  const TwistedCube scene = twisted_cube(0.6, 8);
  Renderer renderer = open(options(), scene.frame);
  const PassTimes times = must(renderer.pass_times(
      must(renderer.draw(scene.frame, scene.snapshot, scene.camera, {}, nullptr))));
  for (const PassTime& pass : kPasses) {
    EXPECT_GE(times.*pass.time, 0.0);
    EXPECT_LT(times.*pass.time, 60'000.0);
  }
  EXPECT_GT(times.draw, 0.0);
}

TEST_F(RendererTest, AnotherSizeIsAnotherRenderer) {
  const TwistedCube scene = twisted_cube(0.6, 8);
  Renderer renderer = open(options(64, 48), scene.frame);
  EXPECT_EQ(picture(renderer, scene).width, 64U);
  renderer = open(options(81, 33), scene.frame);  // odd sides, while the last frame is just done
  const Image image = picture(renderer, scene);
  EXPECT_EQ(image.width, 81U);
  EXPECT_EQ(image.height, 33U);
  EXPECT_EQ(image.rgba.size(), 4U * 81U * 33U);
}

TEST_F(RendererTest, RendererMayEndWhileItDraws) {
  const TwistedCube scene = twisted_cube(0.6, 30);
  Renderer renderer = open(options(), scene.frame);
  must(renderer.draw(scene.frame, scene.snapshot, scene.camera, {}, nullptr));
}

TEST_F(RendererTest, SphereCoversTheAreaOfItsOutline) {
  const double radius = 0.05;
  const double distance = 0.3;
  const double field_of_view = 0.6;
  const FrameWorld frame = make_frame_world(
      {{sphere_mesh(static_cast<float>(radius), 40), {}, glm::vec4(0.2F, 0.2F, 0.2F, 1.0F)}}, {});
  Renderer renderer = open(options(200, 200), frame);
  DrawOptions options;
  options.ground = false;
  const Image image = must(renderer.read_pixels(must(renderer.draw(
      frame, make_snapshot(0, 0), camera_at({0.0, 0.0, distance}, glm::dvec3(0.0), field_of_view),
      options, nullptr))));
  const Pixel background = pixel_at(image, 0, 0);
  double covered = 0.0;
  double x = 0.0;
  double y = 0.0;
  for (std::uint32_t row = 0; row < image.height; ++row) {
    for (std::uint32_t column = 0; column < image.width; ++column) {
      if (difference(pixel_at(image, column, row), background) > 8) {
        covered += 1.0;
        x += column + 0.5;
        y += row + 0.5;
      }
    }
  }
  // Seen from `distance` the outline is a cone of half angle asin(r / d).
  const double focal = 100.0 / std::tan(0.5 * field_of_view);
  const double outline = focal * std::tan(std::asin(radius / distance));
  // A pixel counts when a quarter of it is covered, so the edge lies up to half a pixel out.
  EXPECT_NEAR(std::sqrt(covered / glm::pi<double>()), outline, 0.6);
  EXPECT_NEAR(x / covered, 100.0, 0.2);
  EXPECT_NEAR(y / covered, 100.0, 0.2);
}

TEST_F(RendererTest, UpIsUpAndRightIsRight) {
  const FrameWorld frame = make_frame_world(
      {{box_mesh(glm::vec3(0.01F), 1), {{0.05, 0.08, 0.0}, {1.0, 0.0, 0.0, 0.0}}, glm::vec4(0.1F)}},
      {});
  Renderer renderer = open(options(200, 200), frame);
  DrawOptions options;
  options.ground = false;
  const Image image = must(renderer.read_pixels(
      must(renderer.draw(frame, make_snapshot(0, 0),
                         camera_at({0.0, 0.0, 0.5}, glm::dvec3(0.0), 0.6), options, nullptr))));
  const double focal = 100.0 / std::tan(0.3);
  const auto place = [&](double offset) {
    return static_cast<std::uint32_t>(100.0 + offset);
  };
  const Pixel background = pixel_at(image, 0, 199);
  EXPECT_GT(difference(pixel_at(image, place(focal * 0.05 / 0.5), place(-focal * 0.08 / 0.5)),
                       background),
            40);
  EXPECT_EQ(pixel_at(image, place(-focal * 0.05 / 0.5), place(-focal * 0.08 / 0.5)), background);
  EXPECT_EQ(pixel_at(image, place(focal * 0.05 / 0.5), place(focal * 0.08 / 0.5)), background);
}

TEST_F(RendererTest, OverlayCoversItsPixelsWithItsColor) {
  const TwistedCube scene = twisted_cube(0.6, 8);
  RendererOptions with = options();
  with.overlay_atlas = &kAtlas;
  Renderer renderer = open(with, scene.frame);
  const OverlayDrawList overlay = rectangle(10.0F, 20.0F, 30.0F, 28.0F, 0xFF3264C8U);
  const Image plain = picture(renderer, scene);
  const Image covered = picture(renderer, scene, {}, &overlay);
  for (std::uint32_t y = 0; y < plain.height; ++y) {
    for (std::uint32_t x = 0; x < plain.width; ++x) {
      const bool inside = x >= 10 && x < 30 && y >= 20 && y < 28;
      if (inside) {
        // Decoded and encoded again: at most one level away.
        EXPECT_LE(difference(pixel_at(covered, x, y), {0xC8, 0x64, 0x32}), 1) << x << ' ' << y;
      } else {
        EXPECT_EQ(pixel_at(covered, x, y), pixel_at(plain, x, y)) << x << ' ' << y;
      }
    }
  }
}

TEST_F(RendererTest, SizeOutOfRangeIsAnError) {
  const FrameWorld frame = make_frame_world({}, {});
  for (const auto& [width, height] :
       std::array<std::pair<std::uint32_t, std::uint32_t>, 3>{{{0, 64}, {64, 0}, {16385, 64}}}) {
    const std::string text = error_of(options(width, height), frame);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    EXPECT_NE(text.find(size), std::string::npos) << text;
    EXPECT_NE(text.find("16384"), std::string::npos) << text;
  }
}

TEST_F(RendererTest, OtherNumbersOutOfRangeAreErrors) {
  const FrameWorld frame = make_frame_world({}, {});
  RendererOptions samples = options();
  samples.samples = 3;
  EXPECT_NE(error_of(samples, frame).find("samples a pixel is 3"), std::string::npos);
  RendererOptions shadow = options();
  shadow.shadow_size = 0;
  EXPECT_NE(error_of(shadow, frame).find("side is 0 texels"), std::string::npos);
}

TEST_F(RendererTest, UnknownDeviceNameIsAnErrorThatListsTheDevices) {
  RendererOptions with = options();
  with.device_name = "no such card";
  const std::string text = error_of(with, make_frame_world({}, {}));
  EXPECT_NE(text.find("\"no such card\""), std::string::npos) << text;
  EXPECT_NE(text.find("There are: \""), std::string::npos) << text;
}

}  // namespace
}  // namespace torsion::engine
