// What a material's textures do to pixels, with the shaders for pictures and those for little time.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/srgb.hpp"
#include "tests/render/gpu_fixture.hpp"
#include "tests/render/material_pictures.hpp"
#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

constexpr double kByte = 1.0 / 255.0;

class TexturesTest : public MaterialPictures, public ::testing::WithParamInterface<bool> {
 protected:
  /// The body's material, in a picture of quick or of careful shaders.
  Color middle(const FrameWorld& frame) {
    return at(draw(frame, above(), {}, GetParam()), 0.5, 0.5);
  }

  /// Of a color, linear.
  static double linear(int byte) { return srgb_decoded(kByte * byte); }
};

TEST_P(TexturesTest, MetalAndRoughnessAreTheTexturesTimesTheFactors) {
  FrameWorld frame = slab();
  DrawMaterial& material = frame.materials[0];
  material.color = {0.9F, 0.5F, 0.1F, 1.0F};
  material.metallic = static_cast<float>(204 * kByte);
  material.roughness = static_cast<float>(128 * kByte);
  const Color factors = middle(frame);
  material.metallic = 1.0F;
  material.roughness = 1.0F;
  const Color ones = middle(frame);
  material.texture(TextureRole::kMetalRoughness).image = encoded(plain({7, 128, 204, 255}));
  expect_near(middle(frame), factors, 1);
  EXPECT_GT(std::abs(ones.r - factors.r), 4);
}

TEST_P(TexturesTest, OcclusionTakesOfTheLightFromAllAroundAsMuchAsItSays) {
  FrameWorld frame = slab();
  DrawMaterial& material = frame.materials[0];
  material.color = {0.3F, 0.3F, 0.3F, 1.0F};
  const double without = linear(middle(frame).g);
  material.texture(TextureRole::kOcclusion).image = encoded(plain({0, 255, 255, 255}));
  const auto taken = [&](float strength) {
    material.occlusion_strength = strength;
    return without - linear(middle(frame).g);
  };
  // A byte of this picture is 0.006 of linear light at most.
  EXPECT_NEAR(taken(0.0F), 0.0, 1e-12);
  EXPECT_NEAR(taken(0.5F), 0.5 * taken(1.0F), 0.006);
  EXPECT_GT(taken(1.0F), 0.04);
  EXPECT_LT(taken(1.0F), without - 0.02);  // the key light stays
}

TEST_P(TexturesTest, EmissionIsAddedAndHiddenByAHeatMap) {
  FrameWorld frame = slab();
  DrawMaterial& material = frame.materials[0];
  material.color = {0.1F, 0.1F, 0.1F, 1.0F};
  const Color dark = middle(frame);
  material.emission = {0.4F, 0.0F, 0.0F};
  Color lit = middle(frame);
  EXPECT_NEAR(linear(lit.r) - linear(dark.r), 0.4, 0.01);
  EXPECT_EQ(lit.g, dark.g);
  // Its texture is sRGB: 188 is 0.503.
  material.texture(TextureRole::kEmission).image = encoded(plain({188, 255, 255, 255}));
  lit = middle(frame);
  EXPECT_NEAR(linear(lit.r) - linear(dark.r), 0.4 * linear(188), 0.01);
}

TEST_P(TexturesTest, WhatIsCutOutIsNotThereAndCastsNoShadow) {
  FrameWorld frame = slab();
  DrawMaterial& material = frame.materials[0];
  material.color = {0.9F, 0.05F, 0.05F, 1.0F};
  const Image whole = draw(frame, above(), {}, GetParam());
  // Alpha 60 on the left, 200 on the right.
  Image image{4, 1, {}};
  for (const int alpha : {60, 60, 200, 200}) {
    image.rgba.insert(image.rgba.end(), {255, 255, 255, static_cast<std::uint8_t>(alpha)});
  }
  material.texture(TextureRole::kBaseColor).image = encoded(image);
  spread_texture(frame);
  EXPECT_EQ(draw(frame, above(), {}, GetParam()), whole);  // OPAQUE: alpha says nothing
  material.alpha_mode = AlphaMode::kMask;
  Image seen = draw(frame, above(), {}, GetParam());
  EXPECT_LT(at(seen, 0.25, 0.5).r, 2 * at(seen, 0.25, 0.5).g);  // the floor
  EXPECT_GT(at(seen, 0.75, 0.5).r, 2 * at(seen, 0.75, 0.5).g);
  const auto floor = [&] {
    return sum(at(draw(frame, above(), {}, GetParam()), 0.25, 0.5));
  };
  const int beside = floor();    // the light comes from the left: no shadow falls there
  material.alpha_cutoff = 0.9F;  // nothing is there
  EXPECT_EQ(floor(), beside);
  material.alpha_cutoff = 0.1F;
  seen = draw(frame, above(), {}, GetParam());
  EXPECT_EQ(seen, whole);
}

TEST_P(TexturesTest, AToolThatIsCutAwayCastsNoShadow) {
  FrameWorld frame = shadow_scene();
  const std::uint32_t row = frame.tool_groups.at<DrawGroup>(0).material;
  DrawMaterial& material = frame.materials[row];
  material.color.w = 1.0F;
  material.texture(TextureRole::kBaseColor).image = encoded(plain({255, 255, 255, 128}));
  const auto brightness = [&](AlphaMode mode, float cutoff) {
    material.alpha_mode = mode;
    material.alpha_cutoff = cutoff;
    return sum(at(draw(frame, shadow_camera(), {}, GetParam()), 0.5, 0.5));
  };
  const int opaque = brightness(AlphaMode::kOpaque, 0.5F);
  EXPECT_EQ(brightness(AlphaMode::kMask, 0.4F), opaque);
  EXPECT_GT(brightness(AlphaMode::kMask, 0.6F), opaque + 30);
}

TEST_P(TexturesTest, WhatIsBehindGlassIsSeenThroughIt) {
  // A red ball below a slab, and a body that keeps the floor away from it.
  FrameWorld frame = make_frame_world(
      {{box_mesh({0.1F, 0.01F, 0.1F}, 2), {{0.0, 0.1, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}, {}},
       {box_mesh(glm::vec3(0.01F), 2), {{0.3, 0.01, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}, {}}},
      {{sphere_mesh(0.03F, 8),
        {{0.0, 0.04, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)},
        {0.9F, 0.02F, 0.02F, 1.0F}}});
  DrawMaterial& slab = frame.materials[0];
  DrawMaterial& ball = frame.materials[2];
  ball.alpha_mode = AlphaMode::kOpaque;
  slab.color = {0.2F, 0.2F, 0.6F, 0.2F};
  const Color opaque = middle(frame);
  slab.alpha_mode = AlphaMode::kBlend;
  const Color glass = middle(frame);
  EXPECT_LT(opaque.r, opaque.b);
  EXPECT_GT(glass.r, glass.b);
  slab.color.w = 0.7F;
  const Color dim = middle(frame);
  EXPECT_LT(dim.r, glass.r);
  EXPECT_GT(dim.r, opaque.r);
  // What is above it is not hidden, glass or not.
  frame.tools.at<Pose>(0).position.y = 0.16;
  for (const AlphaMode mode : {AlphaMode::kOpaque, AlphaMode::kBlend}) {
    ball.alpha_mode = mode;
    EXPECT_GT(middle(frame).r, 1.5 * middle(frame).b);
  }
}

TEST_P(TexturesTest, WhatIsDoubleSidedIsSeenFromBehind) {
  // From inside of a box.
  const Camera inside = camera_at({0.0, 0.02, 0.0}, {0.0, 0.0, 0.08}, 0.3);
  FrameWorld frame =
      make_frame_world({{box_mesh(glm::vec3(0.1F), 2), {}, {0.9F, 0.05F, 0.05F, 1.0F}}}, {});
  const auto seen = [&] {
    return at(draw(frame, inside, {}, GetParam()), 0.5, 0.5);
  };
  const Color behind = seen();
  EXPECT_LT(behind.r, 2 * behind.g);
  frame.materials[0].double_sided = true;
  const Color wall = seen();
  EXPECT_GT(wall.r, 2 * wall.g);
}

INSTANTIATE_TEST_SUITE_P(Shaders, TexturesTest, ::testing::Bool(),
                         [](const auto& shaders) { return shaders.param ? "quick" : "careful"; });

class NormalsTextureTest : public MaterialPictures {
 protected:
  /// A flat tool seen from above whose vertices have a normal.
  /// @param across  in which direction u runs, x or -x
  static FrameWorld plate(const glm::vec3& normal, float across) {
    FrameWorld frame = make_frame_world({}, {{box_mesh({0.1F, 0.01F, 0.1F}, 2), {}, {}}});
    for (std::uint32_t i = 0; i < frame.tool_vertices.size(); ++i) {
      const glm::vec4 p = frame.tool_vertices.at<VertexRest>(i).position;
      frame.tool_vertices.at<VertexNormal>(i).normal = glm::vec4(normal, 0.0F);
      frame.tool_vertices.at<VertexPaint>(i).uv = {0.5F + across * 5.0F * p.x, 0.5F + 5.0F * p.z};
    }
    return frame;
  }
};

TEST_F(NormalsTextureTest, IsTheNormalThatVerticesOfThatNormalHave) {
  // glTF: red along u, green against v, blue out. On the plate u runs along x or against it, v
  // along z; +y is out.
  struct Case {
    int red, green;
    float across, scale;
    double behind;  // 1e-4: the picture upright, -1e-4: turned by 180 degrees
  };
  const auto part = [](int byte) {
    return static_cast<float>(2.0 * kByte * byte - 1.0);
  };
  for (const Case& one : {Case{200, 128, 1.0F, 1.0F, 1e-4}, Case{200, 128, -1.0F, 1.0F, 1e-4},
                          Case{128, 190, 1.0F, 1.0F, -1e-4}, Case{128, 70, -1.0F, 1.0F, -1e-4},
                          Case{70, 90, 1.0F, 0.5F, 1e-4}, Case{180, 90, -1.0F, 0.5F, -1e-4}}) {
    const glm::vec3 texel(part(one.red), part(one.green), part(220));
    const Camera camera = camera_at({0.0, 0.3, one.behind}, glm::dvec3(0.0), 0.3);
    const glm::vec3 normal =
        glm::normalize(glm::vec3(one.across * one.scale * texel.x, texel.z, -one.scale * texel.y));
    const Image expected = draw(plate(normal, one.across), camera, ToolLook::kOpaque);
    FrameWorld mapped = plate({0.0F, 1.0F, 0.0F}, one.across);
    mapped.materials[0].texture(TextureRole::kNormal).image = encoded(plain(
        {static_cast<std::uint8_t>(one.red), static_cast<std::uint8_t>(one.green), 220, 255}));
    mapped.materials[0].normal_scale = one.scale;
    expect_near(at(draw(mapped, camera, ToolLook::kOpaque), 0.5, 0.5), at(expected, 0.5, 0.5), 2);
  }
}

}  // namespace
}  // namespace torsion::engine
