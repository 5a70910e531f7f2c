// What materials do to pixels.

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/render/gpu_fixture.hpp"
#include "tests/render/material_pictures.hpp"
#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

class MaterialTest : public MaterialPictures {};

TEST_F(MaterialTest, ATextureIsOnItsPlaceAndTimesTheColor) {
  FrameWorld frame = slab();
  // Red on the left half, green on the right one, white below.
  Image image{4, 4, {}};
  for (int i = 0; i < 16; ++i) {
    const bool left = i % 4 < 2;
    const bool low = i >= 8;
    for (const int c : {left || low ? 255 : 0, !left || low ? 255 : 0, low ? 255 : 0, 255}) {
      image.rgba.push_back(static_cast<std::uint8_t>(c));
    }
  }
  frame.materials[0].texture(TextureRole::kBaseColor).image = encoded(image);
  frame.materials[0].color = {1.0F, 1.0F, 0.0F, 1.0F};
  spread_texture(frame);
  const Image seen = draw(frame, above());
  const Color red = at(seen, 0.25, 0.25);
  const Color green = at(seen, 0.75, 0.25);
  const Color yellow = at(seen, 0.75, 0.75);  // white times the material's colour
  EXPECT_GT(red.r, 2 * red.g);
  EXPECT_GT(green.g, 2 * green.r);
  EXPECT_GT(yellow.r, 150);
  EXPECT_GT(yellow.g, 150);
  EXPECT_LT(yellow.b, 100);  // what is mirrored
}

TEST_F(MaterialTest, AVertexColorIsTimesTheMaterialsAndBetweenItsNeighbours) {
  FrameWorld frame = slab();
  const Image plain = draw(frame, above());
  frame.materials[0].color = {1.0F, 1.0F, 1.0F, 1.0F};
  const Image white = draw(frame, above());
  // From red on the left to green on the right.
  for (std::uint32_t i = 0; i < frame.body_vertices.size(); ++i) {
    const float right = 0.5F + 10.0F * frame.body_vertices.at<VertexRest>(i).position.x;
    frame.body_vertices.at<VertexPaint>(i).color = {1.0F - right, right, 0.0F};
  }
  const Image seen = draw(frame, above());
  EXPECT_GT(at(seen, 0.2, 0.5).r, 2 * at(seen, 0.2, 0.5).g);
  EXPECT_GT(at(seen, 0.8, 0.5).g, 2 * at(seen, 0.8, 0.5).r);
  EXPECT_NEAR(at(seen, 0.5, 0.5).r, at(seen, 0.5, 0.5).g, 12);
  EXPECT_LT(at(seen, 0.5, 0.5).r, at(white, 0.5, 0.5).r);
  for (std::uint32_t i = 0; i < frame.body_vertices.size(); ++i) {
    frame.body_vertices.at<VertexPaint>(i).color = glm::vec3(1.0F);
  }
  EXPECT_EQ(draw(frame, above()), white);
  EXPECT_NE(plain, white);
}

TEST_F(MaterialTest, ATextureThatCannotBeReadLeavesTheColor) {
  FrameWorld frame = slab();
  const Image plain = draw(frame, above());
  frame.materials[0].texture(TextureRole::kBaseColor).image =
      std::make_shared<const EncodedImage>(EncodedImage{"broken", {0x89, 'P', 'N', 'G'}, {}});
  EXPECT_EQ(draw(frame, above()), plain);
}

TEST_F(MaterialTest, EachGroupOfTrianglesHasItsMaterial) {
  FrameWorld frame = slab();
  const Range all = frame.bodies.at<DrawRange>(0).triangles;
  frame.body_groups = {};
  frame.body_groups.reserve(2);
  frame.body_groups.append(2);
  frame.body_groups.at<DrawGroup>(0) = {{all.first, all.count / 2}, 0};
  frame.body_groups.at<DrawGroup>(1) = {{all.first + all.count / 2, all.count / 2}, 1};
  frame.bodies.at<DrawRange>(0).groups = {0, 2};
  frame.materials.push_back(frame.materials[0]);
  frame.materials[0].color = {0.9F, 0.1F, 0.1F, 1.0F};
  frame.materials[1].color = {0.1F, 0.1F, 0.9F, 1.0F};
  // Each half is three faces of six, of which one is out of sight.
  int red = 0;
  int blue = 0;
  for (const glm::dvec3& eye :
       {glm::dvec3(0.0, 0.3, 1e-4), glm::dvec3(0.3, 0.0, 0.0), glm::dvec3(-0.3, 0.0, 0.0),
        glm::dvec3(0.0, 0.0, 0.3), glm::dvec3(0.0, 0.0, -0.3)}) {
    const Color seen = at(draw(frame, camera_at(eye, glm::dvec3(0.0), 0.05)), 0.5, 0.5);
    red += seen.r > 2 * seen.b ? 1 : 0;
    blue += seen.b > 2 * seen.r ? 1 : 0;
  }
  EXPECT_EQ(red + blue, 5);
  EXPECT_GE(std::min(red, blue), 2);
}

TEST_F(MaterialTest, AMetalHasTheColorInWhatItMirrorsAndNoOther) {
  FrameWorld frame = slab();
  frame.materials[0].color = {0.9F, 0.5F, 0.1F, 1.0F};
  frame.materials[0].roughness = 0.3F;
  const Color plastic = at(draw(frame, above()), 0.5, 0.5);
  frame.materials[0].metallic = 1.0F;
  const Color metal = at(draw(frame, above()), 0.5, 0.5);
  // From above it mirrors the ceiling, which is darker than what a diffuse surface gathers.
  EXPECT_LT(sum(metal), sum(plastic));
  EXPECT_GT(metal.r, 2 * metal.b);
}

TEST_F(MaterialTest, AnOpaqueToolCastsADeeperShadowThanGlass) {
  FrameWorld frame = shadow_scene();
  const auto brightness = [&](ToolLook look) {
    return sum(at(draw(frame, shadow_camera(), look), 0.5, 0.5));
  };
  const int glass = brightness(ToolLook::kGlass);
  const int opaque = brightness(ToolLook::kOpaque);
  EXPECT_LT(opaque, glass - 30);
  const std::uint32_t row = frame.tool_groups.at<DrawGroup>(0).material;
  EXPECT_EQ(brightness(ToolLook::kAuthored), glass);  // nobody said what it is made of
  frame.materials[row].alpha_mode = AlphaMode::kOpaque;
  EXPECT_EQ(brightness(ToolLook::kAuthored), opaque);
  frame.materials[row].alpha_mode = AlphaMode::kBlend;
  EXPECT_EQ(brightness(ToolLook::kAuthored), glass);
}

TEST_F(MaterialTest, WhatIsNearerToTheLightThanTheMapReachesCastsItsShadow) {
  // A plate toward the light, 0.33 m along it from the bodies' middle, past the map's 0.26 m;
  // beside the light's axis it is 0.23 m away, within the map.
  const auto picture = [&](double height) {
    const FrameWorld frame = make_frame_world(
        {{box_mesh(glm::vec3(0.05F), 2), {{0.0, 0.05, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}, {}}},
        {{box_mesh({0.02F, 0.002F, 0.02F}, 2),
          {{0.0, height, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)},
          {}}});
    // Where the light through a point at 0.45 m meets the floor.
    const glm::dvec3 shadow = glm::dvec3(0.45, 0.0, -0.40) * (0.45 / 0.85);
    const Camera camera = camera_at(shadow + glm::dvec3(0.01, 0.12, 0.001), shadow, 0.05);
    return sum(at(draw(frame, camera, ToolLook::kOpaque), 0.5, 0.5));
  };
  EXPECT_LT(picture(0.45), picture(0.3) - 30);
}

}  // namespace
}  // namespace torsion::engine
