#include "render/frame_view.hpp"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

constexpr double kAspect = 4.0 / 3.0;
constexpr std::uint32_t kShadowSize = 512;

Pose at(const glm::dvec3& position) {
  return {position, glm::dquat(1.0, 0.0, 0.0, 0.0)};
}

FrameWorld cube_and_ball(const glm::dvec3& ball) {
  return make_frame_world({{box_mesh(glm::vec3(0.05F), 2), at({0.0, 0.05, 0.0}), {}}},
                          {{sphere_mesh(0.02F, 4), at(ball), {}}});
}

TEST(FrameViewTest, ExtentIsTheBodiesBox) {
  const SceneExtent extent = scene_extent(cube_and_ball({0.0, 0.12, 0.0}));
  EXPECT_NEAR(glm::distance(extent.lowest, glm::dvec3(-0.05, 0.0, -0.05)), 0.0, 1e-8);
  EXPECT_NEAR(glm::distance(extent.highest, glm::dvec3(0.05, 0.1, 0.05)), 0.0, 1e-8);
}

TEST(FrameViewTest, ShadowMapHoldsBodiesAndTools) {
  const FrameWorld frame = cube_and_ball({0.0, 0.12, 0.03});
  const SceneExtent extent = scene_extent(frame);
  const shared::FrameUniforms uniforms = frame_uniforms(
      extent, camera_at({0.2, 0.2, 0.3}, {0.0, 0.05, 0.0}, 0.6), kAspect, kShadowSize, {});
  const auto expect_inside = [&](const Pose& pose, const glm::vec4& point) {
    const glm::dvec3 world = pose.rotation * glm::dvec3(point) + pose.position;
    const glm::vec4 place = uniforms.shadow_from_world * glm::vec4(glm::vec3(world), 1.0F);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(place[axis], 0.0F);
      EXPECT_LT(place[axis], 1.0F);
    }
  };
  for (const VertexRest& vertex : frame.body_vertices.column<VertexRest>()) {
    expect_inside(frame.bodies.at<Pose>(0), vertex.position);
  }
  for (const VertexRest& vertex : frame.tool_vertices.column<VertexRest>()) {
    expect_inside(frame.tools.at<Pose>(0), vertex.position);
  }
}

TEST(FrameViewTest, WhatIsNearerToTheLightIsLessDeepInTheShadowMap) {
  const SceneExtent extent = scene_extent(cube_and_ball({0.0, 0.12, 0.0}));
  const shared::FrameUniforms uniforms = frame_uniforms(
      extent, camera_at({0.2, 0.2, 0.3}, {0.0, 0.05, 0.0}, 0.6), kAspect, kShadowSize, {});
  const glm::vec4 low(0.0F, 0.01F, 0.0F, 1.0F);
  const glm::vec4 high = low + 0.05F * glm::vec4(glm::vec3(uniforms.to_key_light), 0.0F);
  const glm::vec4 low_place = uniforms.shadow_from_world * low;
  const glm::vec4 high_place = uniforms.shadow_from_world * high;
  EXPECT_NEAR(low_place.x, high_place.x, 1e-6F);
  EXPECT_NEAR(low_place.y, high_place.y, 1e-6F);
  EXPECT_LT(high_place.z, low_place.z);
}

TEST(FrameViewTest, AToolFarAwayDoesNotSpoilTheShadowMap) {
  const SceneExtent near = scene_extent(cube_and_ball({0.0, 0.12, 0.0}));
  const SceneExtent far = scene_extent(cube_and_ball({0.0, 50.0, 0.0}));
  // Three times the half diagonal of the cube.
  EXPECT_NEAR(far.radius, 3.0 * 0.05 * std::sqrt(3.0), 1e-8);
  EXPECT_LT(near.radius, far.radius);
}

TEST(FrameViewTest, TorqueArcGoesAroundTheTool) {
  const SceneExtent extent = scene_extent(cube_and_ball({0.0, 0.12, 0.0}));
  ASSERT_EQ(extent.arc_radii.size(), 1U);
  EXPECT_GT(extent.arc_radii[0], 0.02);        // outside the ball
  EXPECT_LE(extent.arc_radii[0], 0.75 * 0.1);  // and not wider than the cube
}

TEST(FrameViewTest, EmptySceneHasAnExtent) {
  const SceneExtent extent = scene_extent(make_frame_world({}, {}));
  EXPECT_GT(extent.radius, 0.0);
}

TEST(FrameViewTest, GridSpacingIsRoundWithAtLeastTenLines) {
  const std::array<std::array<double, 2>, 5> cases = {
      {{0.1, 0.01}, {0.06, 0.005}, {0.03, 0.002}, {1.0, 0.1}, {0.0999, 0.005}}};
  for (const auto& [size, spacing] : cases) {
    EXPECT_NEAR(grid_spacing(size), spacing, 1e-12) << size;
  }
  EXPECT_EQ(grid_spacing(0.0), 0.0);
}

TEST(FrameViewTest, HeatScaleMapsItsEndsToTheRowsEnds) {
  const SceneExtent extent = scene_extent(cube_and_ball({0.0, 0.12, 0.0}));
  const Camera camera = camera_at({0.2, 0.2, 0.3}, {0.0, 0.05, 0.0}, 0.6);
  const auto place = [&](HeatMap map, float value) {
    DrawOptions options;
    options.heat_map = map;
    options.heat_limit = 4.0;
    const glm::vec4 scale =
        frame_uniforms(extent, camera, kAspect, kShadowSize, options).heat_scale;
    return (value - scale.x) * scale.y;
  };
  EXPECT_FLOAT_EQ(place(HeatMap::kTwist, -4.0F), 0.0F);
  EXPECT_FLOAT_EQ(place(HeatMap::kTwist, 0.0F), 0.5F);
  EXPECT_FLOAT_EQ(place(HeatMap::kTwist, 4.0F), 1.0F);
  EXPECT_FLOAT_EQ(place(HeatMap::kPressure, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(place(HeatMap::kPressure, 4.0F), 1.0F);
}

TEST(FrameViewTest, ContactSpotsAreThoseOfEachBodyInOrder) {
  Snapshot snapshot = make_snapshot(0, 3);
  const std::array<std::uint32_t, 3> bodies = {1, 0, 1};
  for (std::uint32_t region = 0; region < 3; ++region) {
    snapshot.regions.append();
    snapshot.regions.at<RegionIdentity>(region).body = bodies[region];
    snapshot.regions.at<Contact>(region).radius = 0.01 * (region + 1);
  }
  std::vector<shared::ContactSpot> spots;
  std::vector<Range> ranges;
  contact_spots(snapshot, 2, spots, ranges);
  ASSERT_EQ(spots.size(), 3U);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(ranges[0].count, 1U);
  EXPECT_EQ(ranges[1].count, 2U);
  EXPECT_FLOAT_EQ(spots[0].center_and_radius.w, 0.02F);
  EXPECT_FLOAT_EQ(spots[1].center_and_radius.w, 0.01F);
  EXPECT_FLOAT_EQ(spots[2].center_and_radius.w, 0.03F);
}

TEST(FrameViewTest, PoseRowsPlaceAPoint) {
  const Pose pose{glm::dvec3(1.0, 2.0, 3.0),
                  glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)))};
  shared::DrawConstants constants{};
  set_pose(pose, constants);
  const glm::dvec3 point(0.3, -0.2, 0.1);
  const glm::dvec3 expected = pose.rotation * point + pose.position;
  for (int row = 0; row < 3; ++row) {
    // Rows are floats of numbers up to 3.
    EXPECT_NEAR(glm::dot(glm::dvec4(constants.to_world[row]), glm::dvec4(point, 1.0)),
                expected[row], 4e-7);
  }
}

}  // namespace
}  // namespace torsion::engine
