// Pictures against those in tests/images, on lavapipe, so that what a person sees changes only when
// somebody means it to. To draw them anew: TORSION_UPDATE_IMAGES=1 render_tests
// --gtest_filter='GoldenTest.*', look at each, and say in the commit why it changed.

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "render/image_io.hpp"
#include "tests/render/gpu_fixture.hpp"
#include "tests/render/render_scenes.hpp"
#include "tests/support/image_compare.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 240;
constexpr double kTurn = 1.0;  // rad

class GoldenTest : public GpuTest {
 protected:
  Image draw(double turn, const DrawOptions& draw_options) {
    const TwistedCube scene = twisted_cube(turn, 40);
    RendererOptions with = options(kWidth, kHeight);
    with.device_name = "llvmpipe";  // the pictures are its
    Renderer renderer = open(with, scene.frame);
    return must(renderer.read_pixels(
        must(renderer.draw(scene.frame, scene.snapshot, scene.camera, draw_options, nullptr))));
  }

  static std::filesystem::path golden_path(const std::string& name) {
    return std::filesystem::path(test::source_folder()) / "tests/images" / (name + ".png");
  }

  /// Leaves NAME.actual.png and NAME.difference.png in the build folder's `images` when it fails.
  static void expect_golden(const Image& image, const std::string& name) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing sets it
    if (std::getenv("TORSION_UPDATE_IMAGES") != nullptr) {
      must(write_png(image, golden_path(name)));
    }
    const Image golden = must(read_png(golden_path(name)));
    const ImageDifference difference = compare(image, golden);
    if (close_enough(difference)) {
      return;
    }
    const std::filesystem::path kept = std::filesystem::path(test::build_folder()) / "images";
    std::filesystem::create_directories(kept);
    must(write_png(image, kept / (name + ".actual.png")));
    if (difference.same_size) {
      must(write_png(difference_picture(image, golden), kept / (name + ".difference.png")));
    }
    ADD_FAILURE() << name << ": " << difference.text() << "; see " << kept;
  }
};

TEST_F(GoldenTest, MaterialLinesTurnUnderTheTool) {
  expect_golden(draw(kTurn, {}), "twisted_cube");
}

TEST_F(GoldenTest, TwistIsBlueOneWay) {
  DrawOptions options;
  options.heat_map = HeatMap::kTwist;
  expect_golden(draw(-kTurn, options), "twisted_cube_heat_negative");
}

TEST_F(GoldenTest, TwistIsRedTheOtherWay) {
  DrawOptions options;
  options.heat_map = HeatMap::kTwist;
  expect_golden(draw(kTurn, options), "twisted_cube_heat_positive");
}

TEST_F(GoldenTest, PressureShowsThroughTheTool) {
  DrawOptions options;
  options.heat_map = HeatMap::kPressure;
  options.heat_limit = 4e4;
  expect_golden(draw(kTurn, options), "twisted_cube_pressure");
}

TEST_F(GoldenTest, OpaqueToolHidesTheContactAndShadesIt) {
  DrawOptions options;
  options.tools = ToolLook::kOpaque;
  options.arrows = false;
  expect_golden(draw(kTurn, options), "twisted_cube_opaque_tool");
}

// What the comparison must not let through: without this a tolerance that is too wide goes unseen.
TEST_F(GoldenTest, WrongPicturesAreSeen) {
  const Image golden = must(read_png(golden_path("twisted_cube")));
  EXPECT_TRUE(close_enough(compare(draw(kTurn, {}), golden)));
  EXPECT_FALSE(close_enough(compare(draw(1.03 * kTurn, {}), golden)));  // 1.7 degrees at the tool
  DrawOptions options;
  options.ground = false;
  EXPECT_FALSE(close_enough(compare(draw(kTurn, options), golden)));
  options = {};
  options.arrows = false;
  EXPECT_FALSE(close_enough(compare(draw(kTurn, options), golden)));
  options = {};
  options.grid = false;
  EXPECT_FALSE(close_enough(compare(draw(kTurn, options), golden)));
}

}  // namespace
}  // namespace torsion::engine
