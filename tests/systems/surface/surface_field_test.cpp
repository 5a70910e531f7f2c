#include "systems/surface/surface_field.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "tests/systems/surface/drawn_body.hpp"

namespace torsion::engine {
namespace {

TEST(SurfaceFieldTest, FixedVerticesStay) {
  for (const FixedKind fixed : {FixedKind::kFace, FixedKind::kPoint}) {
    Drawn drawn(exact_body(ShapeKind::kBox, glm::dvec3(0.05), fixed, 20));
    twisting_region(drawn.world, 0.5, 0.02, 0.02);
    add_region(drawn.world, {.point = {0.05, 0.0, 0.01},
                             .normal = {1.0, 0.0, 0.0},
                             .force_on_body = {-3.0, 1.0, 2.0},
                             .radius = 0.01,
                             .depth = 0.003});
    drawn.draw();
    int seen = 0;
    for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
      if (drawn.frame.body_vertices.at<VertexRest>(v).position.w == 1.0F) {
        EXPECT_EQ(glm::vec3(drawn.positions[v]),
                  glm::vec3(drawn.frame.body_vertices.at<VertexRest>(v).position));
        EXPECT_EQ(drawn.twist(0, v), 0.0);
        ++seen;
      }
    }
    EXPECT_GE(seen, 1);
  }
}

TEST(SurfaceFieldTest, VertexAtAnAnchorMovesWithIt) {
  BodyDescription body = exact_body(ShapeKind::kBox, {0.015, 0.1, 0.025}, FixedKind::kFace, 8);
  const World first = body_world(body);
  for (const AnchorRest& anchor : first.model.anchors.column<AnchorRest>()) {
    body.draw.positions.emplace_back(anchor.position);
    body.draw.normals.emplace_back(glm::vec3(0.0F, 1.0F, 0.0F));
    body.draw.fixed.push_back(false);
  }
  Drawn drawn(body);
  add_region(drawn.world,
             {.point = {0.0, 0.1, 0.0}, .force_on_body = {0.2, -1.0, 0.1}, .radius = 0.0});
  drawn.draw();
  const std::uint32_t count = drawn.world.model.anchors.size();
  double largest = 0.0;
  for (std::uint32_t j = 0; j < count; ++j) {
    const glm::dvec3 wanted = drawn.snapshot.anchors.at<AnchorMotion>(j).displacement;
    largest = std::max(largest, glm::length(wanted));
    const std::uint32_t v = drawn.vertices() - count + j;
    if (drawn.rest(v).y > -0.09) {
      EXPECT_NEAR(glm::distance(drawn.moved(v) - drawn.rest(v), wanted), 0.0, 1e-6);
    }
  }
  EXPECT_GT(largest, 1e-3);
}

TEST(SurfaceFieldTest, BentBarFollowsTimoshenkoBetweenTheAnchors) {
  const double length = 0.2;
  Drawn drawn(exact_body(ShapeKind::kBox, {0.015, length / 2, 0.025}, FixedKind::kFace, 16));
  const double force = 0.3;
  add_region(drawn.world,
             {.point = {0.0, length / 2, 0.0}, .force_on_body = {force, 0.0, 0.0}, .radius = 0.0});
  drawn.draw();
  const double moment = 0.05 * std::pow(0.03, 3) / 12.0;
  const double tip = force * std::pow(length, 3) / (3.0 * 3e6 * moment) +
                     force * length / (5.0 / 6.0 * 1e6 * 0.0015);
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    const double s = drawn.rest(v).y + length / 2;
    const double deflection = force * s * s * (3.0 * length - s) / (6.0 * 3e6 * moment) +
                              force * s / (5.0 / 6.0 * 1e6 * 0.0015);
    // Anchors are right to 1e-3 (skeleton_test.cpp); at the edges, half a spacing beyond them, the
    // spline of least bending energy is 1.3 % flatter than the bar.
    EXPECT_NEAR(drawn.moved(v).x - drawn.rest(v).x, deflection, 0.015 * tip) << "s = " << s;
  }
}

TEST(SurfaceFieldTest, NoVertexIsInsideTheTool) {
  for (const double depth : {0.0005, 0.004, 0.015}) {
    Drawn drawn(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 60));
    press_sphere(drawn.world, 0.05, depth, {0.013, -0.007});
    twisting_region(drawn.world, 0.3, 0.01, 0.01);
    drawn.draw();
    double touching = 0;
    for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
      const glm::dvec3 in_tool =
          to_inner(drawn.world.state.tools.at<ToolPose>(0).now, drawn.moved(v));
      const double gap = glm::length(in_tool) - 0.05;
      EXPECT_GT(gap, -1e-7);  // two roundings to float of coordinates of 0.1 m
      touching += gap < 1e-4 ? 1 : 0;
    }
    EXPECT_GT(touching, 0);
  }
}

TEST(SurfaceFieldTest, BesideASteepWallVerticesGoToTheWallNotDownAllOfIt) {
  // A pin of radius 5 mm, 12 mm deep: vertices from 1 um inside its wall on inwards.
  BodyDescription body = exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 20);
  body.models.body = BodyModel::kNone;
  const std::size_t first = body.draw.positions.size();
  for (int i = 0; i < 400; ++i) {
    const double inside = 1e-6 * std::pow(1.02, i);  // m, up to 2.7 mm
    body.draw.positions.emplace_back(glm::vec3(0.005 - inside, 0.05, 0.0));
    body.draw.normals.emplace_back(glm::vec3(0.0F, 1.0F, 0.0F));
    body.draw.fixed.push_back(false);
  }
  Drawn drawn(body);
  ShapePart& pin = drawn.world.model.parts.at<ShapePart>(1);
  pin.kind = ShapeKind::kCapsule;
  pin.half_extent = glm::dvec3(0.005, 0.03, 0.005);
  drawn.world.model.tools.at<Bounds>(0) = {-pin.half_extent, pin.half_extent};
  const double depth = 0.012;
  drawn.world.state.tools.at<ToolPose>(0).now.position = glm::dvec3(0.0, 0.05 + 0.03 - depth, 0.0);
  add_region(drawn.world, {.point = {0.0, 0.05, 0.0}, .radius = 0.005, .depth = depth});
  drawn.draw();
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    // Pushed out of the pin, but never farther than its tip is deep.
    EXPECT_LT(glm::distance(drawn.moved(v), drawn.rest(v)), 1.01 * depth);
    const glm::dvec3 in_tool =
        to_inner(drawn.world.state.tools.at<ToolPose>(0).now, drawn.moved(v));
    EXPECT_GT(signed_distance(drawn.world.model, {1, 1}, in_tool).value, -1e-7);
  }
  for (auto v = static_cast<std::uint32_t>(first + 1); v < drawn.vertices(); ++v) {
    // The wall holds neighbours: the surface is stretched along it, not torn.
    EXPECT_LT(glm::distance(drawn.moved(v), drawn.moved(v - 1)), 0.05 * depth);
  }
}

TEST(SurfaceFieldTest, SurfaceUnderTheSphereLiesOnIt) {
  // Hertz: under a sphere, within the contact radius, the body takes the sphere's shape.
  BodyDescription body = exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 100);
  body.models.body = BodyModel::kNone;
  Drawn drawn(body);
  const double depth = 0.001;
  press_sphere(drawn.world, 0.05, depth, {0.0, 0.0});
  drawn.draw();
  const double contact_radius = std::sqrt(0.05 * depth);
  int seen = 0;
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    const glm::dvec3 x = drawn.rest(v);
    if (x.y > 0.05 - 1e-9 && std::hypot(x.x, x.z) < 0.95 * contact_radius) {
      const double gap =
          glm::distance(drawn.moved(v), drawn.world.state.tools.at<ToolPose>(0).now.position) -
          0.05;
      EXPECT_NEAR(gap, 0.0, 0.01 * depth);
      EXPECT_GT(drawn.frame.body_vertices.at<VertexDisplacement>(v).displacement.w, 0.0F);
      ++seen;
    }
  }
  EXPECT_GT(seen, 20);
}

TEST(SurfaceFieldTest, FieldIsContinuousAcrossTheRegionsRim) {
  // A row of vertices 10 um apart over the top face, through the contact and out to the edge.
  BodyDescription body = exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 4);
  constexpr int kPoints = 9000;
  const std::size_t first = body.draw.positions.size();
  for (int i = 0; i < kPoints; ++i) {
    body.draw.positions.emplace_back(
        glm::vec3(-0.045F + 1e-5F * static_cast<float>(i), 0.05F, 0.003F));
    body.draw.normals.emplace_back(glm::vec3(0.0F, 1.0F, 0.0F));
    body.draw.fixed.push_back(false);
  }
  Drawn drawn(body);
  press_sphere(drawn.world, 0.05, 0.006, {0.004, 0.0});
  drawn.world.state.regions.at<RegionFriction>(0).stick_turn = 0.3;
  drawn.world.state.regions.at<RegionFriction>(0).stick_radius = 0.01;
  drawn.world.state.regions.at<RegionMotion>(0).axis_share = 1.0;
  drawn.world.state.regions.at<RegionMotion>(0).axis = kUp;
  drawn.draw();
  for (std::size_t i = first + 1; i < first + kPoints; ++i) {
    const auto v = static_cast<std::uint32_t>(i);
    const glm::dvec3 step = drawn.moved(v) - drawn.moved(v - 1);
    // 10 um apart at rest; the shape's strains and turns are below 1, so neighbours stay within 20
    // um. A jump at a branch would be a share of the depth, 6 mm.
    EXPECT_LT(glm::length(step), 2e-5) << "at x = " << drawn.rest(v).x;
    EXPECT_NEAR(drawn.twist(0, v), drawn.twist(0, v - 1), 1e-3);
    const float pressure = drawn.frame.body_vertices.at<VertexDisplacement>(v).displacement.w;
    const float before = drawn.frame.body_vertices.at<VertexDisplacement>(v - 1).displacement.w;
    const double mean = drawn.world.state.regions.at<RegionNormal>(0).force /
                        drawn.world.state.regions.at<Contact>(0).area;
    EXPECT_NEAR(static_cast<double>(pressure - before), 0.0, 0.02 * mean);
  }
}

TEST(SurfaceFieldTest, BodyWithoutContactIsDrawnAtRest) {
  Drawn drawn = cube();
  twisting_region(drawn.world, 0.1, 0.01, 0.02);
  drawn.draw();
  drawn.world.state.regions.clear();
  drawn.draw();
  EXPECT_EQ(drawn.frame.bodies.at<FrameBody>(0).regions_drawn, 0U);
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    EXPECT_EQ(glm::vec3(drawn.positions[v]),
              glm::vec3(drawn.frame.body_vertices.at<VertexRest>(v).position));
  }
}

TEST(SurfaceFieldTest, ToolsAreDrawnWhereTheSnapshotHasThem) {
  Drawn drawn = cube();
  drawn.world.state.tools.at<ToolPose>(0).now = {glm::dvec3(1.0, 2.0, 3.0),
                                                 glm::dquat(0.6, 0.8, 0.0, 0.0)};
  drawn.draw();
  EXPECT_EQ(drawn.frame.tools.at<Pose>(0).position, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(drawn.frame.tools.at<Pose>(0).rotation, glm::dquat(0.6, 0.8, 0.0, 0.0));
}

}  // namespace
}  // namespace torsion::engine
