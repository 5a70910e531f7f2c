#include "tests/render/material_pictures.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <unistd.h>

#include "render/image_io.hpp"

namespace torsion::engine {
namespace {

const glm::dvec3 kShadowedBall(0.12, 0.1, 0.0);  // m

}  // namespace

void expect_near(const Color& color, const Color& expected, int tolerance) {
  EXPECT_NEAR(color.r, expected.r, tolerance);
  EXPECT_NEAR(color.g, expected.g, tolerance);
  EXPECT_NEAR(color.b, expected.b, tolerance);
}

std::shared_ptr<const EncodedImage> MaterialPictures::encoded(const Image& image) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("torsion_material_" + std::to_string(::getpid()) + ".png");
  must(write_png(image, path));
  std::ifstream stream(path, std::ios::binary);
  EncodedImage read{"test", {std::istreambuf_iterator<char>(stream), {}}, {}};
  std::filesystem::remove(path);
  return std::make_shared<const EncodedImage>(std::move(read));
}

Image MaterialPictures::plain(const std::array<std::uint8_t, 4>& rgba) {
  return {1, 1, {rgba.begin(), rgba.end()}};
}

Image MaterialPictures::draw(const FrameWorld& frame, const Camera& camera, ToolLook look,
                             std::optional<bool> quick) {
  RendererOptions renderer_options = options();
  renderer_options.quick = quick;
  Renderer renderer = open(renderer_options, frame);
  DrawOptions draw;
  draw.grid = false;
  draw.tools = look;
  const Snapshot snapshot = make_snapshot(frame.tools.size(), 0);
  return must(renderer.read_pixels(must(renderer.draw(frame, snapshot, camera, draw, nullptr))));
}

Color MaterialPictures::at(const Image& image, double x, double y) {
  const auto column = static_cast<std::size_t>(x * image.width);
  const auto row = static_cast<std::size_t>(y * image.height);
  const std::uint8_t* pixel = &image.rgba[4 * (row * image.width + column)];
  return {pixel[0], pixel[1], pixel[2]};
}

FrameWorld MaterialPictures::slab() {
  return make_frame_world({{box_mesh({0.1F, 0.01F, 0.1F}, 2), {}, {}}}, {});
}

void MaterialPictures::spread_texture(FrameWorld& frame) {
  for (std::uint32_t i = 0; i < frame.body_vertices.size(); ++i) {
    const glm::vec4 p = frame.body_vertices.at<VertexRest>(i).position;
    frame.body_vertices.at<VertexPaint>(i).uv = {0.5F + 10.0F * p.x, 0.5F + 10.0F * p.z};
  }
}

FrameWorld MaterialPictures::shadow_scene() {
  return make_frame_world(
      {{box_mesh(glm::vec3(0.05F), 2), {{0.0, 0.05, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}, {}}},
      {{sphere_mesh(0.02F, 8), {kShadowedBall, glm::dquat(1.0, 0.0, 0.0, 0.0)}, {}}});
}

Camera MaterialPictures::shadow_camera() {
  // From the ball's middle against the light, whose direction is (-0.45, 0.85, 0.40).
  const glm::dvec3 shadow =
      kShadowedBall - glm::dvec3(-0.45, 0.85, 0.40) * (kShadowedBall.y / 0.85);
  return camera_at(shadow + glm::dvec3(0.05, 0.4, 0.001), shadow, 0.05);
}

}  // namespace torsion::engine
