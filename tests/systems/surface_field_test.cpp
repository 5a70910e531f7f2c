#include "systems/surface_field.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "systems/body_models/skeleton.hpp"
#include "systems/distance.hpp"
#include "systems/frames.hpp"
#include "systems/region_field.hpp"
#include "tests/systems/body_scene.hpp"

namespace torsion {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// One body with its frame world; regions are put on it by hand.
struct Drawn {
  explicit Drawn(BodyDescription body) {
    scene.bodies.push_back(std::move(body));
    world = body_world(scene.bodies.front());
    ToolDescription tool;
    scene.tools.push_back(tool);
    frame = prepare_frame(scene, world);
    snapshot.reserve(world);
  }

  /// Runs the skeleton and the surface field on what the world holds now.
  void draw() {
    run_skeleton(world);
    draw_as_is();
  }
  void draw_as_is() {
    capture(world, snapshot);
    surface_field(world, snapshot, frame);
    positions.resize(frame.body_vertices.size());
    deform_vertices(frame, 0, positions);
  }

  [[nodiscard]] glm::dvec3 rest(std::uint32_t vertex) const {
    return glm::dvec3(frame.body_vertices.at<VertexRest>(vertex).position);
  }
  [[nodiscard]] double twist(std::uint32_t slot, std::uint32_t vertex) const {
    return static_cast<double>(
        frame.twist.at<TwistAngle>(slot * frame.body_vertices.size() + vertex).angle);
  }
  [[nodiscard]] glm::dvec3 moved(std::uint32_t vertex) const {
    return glm::dvec3(positions[vertex]);
  }
  [[nodiscard]] std::uint32_t vertices() const { return frame.body_vertices.size(); }

  SceneDescription scene;
  World world;
  FrameWorld frame;
  Snapshot snapshot;
  std::vector<glm::vec4> positions;
};

constexpr glm::dvec3 kUp(0.0, 1.0, 0.0);

Drawn cube() {
  return Drawn(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 20));
}

/// A region in the middle of the top face through which the tool's axis goes, as the contact model
/// leaves it.
std::uint32_t twisting_region(World& world, double stick_turn, double stick_radius, double radius) {
  const std::uint32_t region = add_region(world, {.point = {0.0, 0.05, 0.0}, .radius = radius});
  world.regions.at<RegionMotion>(region) = RegionMotion{};
  world.regions.at<RegionMotion>(region).axis = kUp;
  world.regions.at<RegionMotion>(region).axis_share = 1.0;
  world.regions.at<RegionFriction>(region).stick_turn = stick_turn;
  world.regions.at<RegionFriction>(region).stick_radius = stick_radius;
  return region;
}

/// Puts the tool, a sphere of radius 0.05 m, so that it overlaps the top of a body of that height
/// by `depth`, and a region that the overlap would give.
void press_sphere(World& world, double top, double depth, const glm::dvec2& place) {
  const double radius = std::sqrt(2.0 * 0.05 * depth - depth * depth);
  add_region(world, {.point = {place.x, top, place.y},
                     .force_on_body = {0.0, -1.0, 0.0},
                     .radius = radius,
                     .depth = depth});
  world.tools.at<ToolPose>(0).now.position = glm::dvec3(place.x, top + 0.05 - depth, place.y);
}

TEST(SurfaceFieldTest, AnglesAreThePapersThroughTheRegion) {
  Drawn drawn = cube();
  const double phi = 0.3;
  const double r_m = 0.012;
  twisting_region(drawn.world, phi, r_m, 0.02);
  drawn.draw();
  ASSERT_EQ(drawn.frame.bodies.at<FrameBody>(0).regions_drawn, 1U);
  int inside = 0;
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    const glm::dvec3 x = drawn.rest(v);
    const double height = (x.y + 0.05) / 0.1;
    if (height < 0.06) {
      continue;  // beside the fixed face motion fades: FixedVerticesStay
    }
    // (11) and (13): phi_m up to r_m, r_m phi_m / r beyond; times l_u / l_contact.
    const double r = std::hypot(x.x, x.z);
    const double expected = phi * std::min(1.0, r_m / std::max(r, 1e-12)) * height;
    EXPECT_NEAR(drawn.twist(0, v), expected, 1e-6);  // float angles of at most 0.3 rad
    inside += r < r_m ? 1 : 0;
  }
  EXPECT_GT(inside, 0);
}

TEST(SurfaceFieldTest, PositiveAnglesTurnCounterClockwiseSeenFromOutside) {
  for (const double phi : {0.4, -0.4}) {
    Drawn drawn = cube();
    twisting_region(drawn.world, phi, 0.02, 0.02);
    drawn.draw();
    for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
      const glm::dvec3 x = drawn.rest(v);
      if (x.y < 0.05 - 1e-9 || std::hypot(x.x, x.z) > 0.02 || std::hypot(x.x, x.z) < 1e-6) {
        continue;
      }
      const glm::dvec3 expected = glm::angleAxis(phi, kUp) * x;
      EXPECT_NEAR(glm::distance(drawn.moved(v), expected), 0.0, 1e-7);
      EXPECT_GT(phi * glm::dot(glm::cross(x, drawn.moved(v)), kUp), 0.0);
    }
  }
}

TEST(SurfaceFieldTest, OppositeTurnsGiveMirroredShapes) {
  Drawn left = cube();
  twisting_region(left.world, 0.4, 0.012, 0.02);
  left.draw();
  Drawn right = cube();
  twisting_region(right.world, -0.4, 0.012, 0.02);
  right.draw();
  for (std::uint32_t v = 0; v < left.vertices(); ++v) {
    // The turn by -phi of the mirror image (z -> -z) is the mirror image of the turn by phi.
    const glm::dvec3 mirrored = left.rest(v) * glm::dvec3(1.0, 1.0, -1.0);
    for (std::uint32_t other = 0; other < right.vertices(); ++other) {
      if (glm::distance(right.rest(other), mirrored) < 1e-9) {
        const glm::dvec3 image = left.moved(v) * glm::dvec3(1.0, 1.0, -1.0);
        EXPECT_NEAR(glm::distance(right.moved(other), image), 0.0, 1e-7);
        break;
      }
    }
  }
}

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

TEST(SurfaceFieldTest, NothingBehindTheFixedPointTurns) {
  // Pressed from the side: what lies beyond the plane through the fixed point keeps its place.
  Drawn drawn(exact_body(ShapeKind::kEllipsoid, {0.06, 0.04, 0.05}, FixedKind::kPoint, 10));
  const std::uint32_t region = add_region(
      drawn.world, {.point = {0.06, 0.0, 0.0}, .normal = {1.0, 0.0, 0.0}, .radius = 0.01});
  drawn.world.regions.at<RegionMotion>(region).axis_share = 1.0;
  drawn.world.regions.at<RegionMotion>(region).axis = glm::dvec3(1.0, 0.0, 0.0);
  drawn.world.regions.at<RegionFriction>(region).stick_turn = 0.5;
  drawn.world.regions.at<RegionFriction>(region).stick_radius = 0.01;
  drawn.draw();
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    if (drawn.rest(v).x <= 0.0) {
      EXPECT_EQ(drawn.twist(0, v), 0.0);
    }
  }
}

TEST(SurfaceFieldTest, TorqueOfAnAxisThatMissesTheRegionTwistsBarsAsSaintVenantSays) {
  struct Case {
    ShapeKind kind;
    glm::dvec3 half;
    double torque;  // N m
    double turn;    // rad at the top, physics B8 with G = 1e6 Pa
  };
  const Case cases[] = {{ShapeKind::kCylinder, {0.02, 0.1, 0.02}, 6.28318531e-2, 0.05},
                        {ShapeKind::kBox, {0.05, 0.1, 0.05}, 0.702885075, 0.01}};
  for (const Case& bar : cases) {
    Drawn drawn(exact_body(bar.kind, bar.half, FixedKind::kFace, 12));
    const std::uint32_t region =
        add_region(drawn.world, {.point = {0.0, bar.half.y, 0.0}, .radius = 0.005});
    drawn.world.regions.at<RegionMotion>(region).axis = kUp;
    drawn.world.regions.at<RegionWrench>(region).on_tool.torque = -bar.torque * kUp;
    drawn.world.tools.at<ToolMotion>(0).axis = kUp;
    drawn.world.tools.at<ToolMotion>(0).axis_turn = 1e6;
    drawn.world.tools.at<ToolMotion>(0).mass_center = glm::dvec3(0.0, 0.3, 0.0);
    drawn.draw();
    for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
      const double share = (drawn.rest(v).y + bar.half.y) / (2.0 * bar.half.y);
      if (share < 0.1) {
        continue;
      }
      EXPECT_NEAR(drawn.twist(0, v), bar.turn * share, 0.01 * bar.turn);
      const glm::dvec3 expected = glm::angleAxis(bar.turn * share, kUp) * drawn.rest(v);
      EXPECT_NEAR(glm::distance(drawn.moved(v), expected), 0.0, 0.01 * bar.turn * 2.0 * bar.half.x);
    }
  }
}

TEST(SurfaceFieldTest, TorqueAgainstTheAxisTurnsTheSameWayAsAlongTheFlippedAxis) {
  double turns[2] = {};
  for (int i = 0; i < 2; ++i) {
    Drawn drawn = cube();
    const glm::dvec3 axis = i == 0 ? kUp : -kUp;
    const std::uint32_t region =
        add_region(drawn.world, {.point = {0.0, 0.05, 0.0}, .radius = 0.005});
    drawn.world.regions.at<RegionMotion>(region).axis = axis;
    drawn.world.regions.at<RegionWrench>(region).on_tool.torque = -0.1 * kUp;
    drawn.world.tools.at<ToolMotion>(0).axis = axis;
    drawn.world.tools.at<ToolMotion>(0).axis_turn = 1.0;
    drawn.draw();
    const std::uint32_t v = 4 * 21 * 21;  // a corner of the top face
    ASSERT_NEAR(drawn.rest(v).y, 0.05, 1e-9);
    turns[i] = glm::dot(glm::cross(drawn.rest(v), drawn.moved(v)), kUp);
  }
  EXPECT_GT(turns[0], 0.0);
  EXPECT_NEAR(turns[0], turns[1], 1e-9);
}

TEST(SurfaceFieldTest, VertexAtAnAnchorMovesWithIt) {
  BodyDescription body = exact_body(ShapeKind::kBox, {0.015, 0.1, 0.025}, FixedKind::kFace, 8);
  const World first = body_world(body);
  for (const AnchorRest& anchor : first.anchors.column<AnchorRest>()) {
    body.draw.positions.emplace_back(anchor.position);
    body.draw.normals.emplace_back(glm::vec3(0.0F, 1.0F, 0.0F));
    body.draw.fixed.push_back(false);
  }
  Drawn drawn(body);
  add_region(drawn.world,
             {.point = {0.0, 0.1, 0.0}, .force_on_body = {0.2, -1.0, 0.1}, .radius = 0.0});
  drawn.draw();
  const std::uint32_t count = drawn.world.anchors.size();
  double largest = 0.0;
  for (std::uint32_t j = 0; j < count; ++j) {
    const glm::dvec3 wanted = drawn.world.anchors.at<AnchorMotion>(j).displacement;
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
    // Anchors are right to 1e-3 (skeleton_test.cpp); at the edges, half a spacing beyond them, the spline of least
    // bending energy is 1.3 % flatter than the bar.
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
      const glm::dvec3 in_tool = to_inner(drawn.world.tools.at<ToolPose>(0).now, drawn.moved(v));
      const double gap = glm::length(in_tool) - 0.05;
      EXPECT_GT(gap, -1e-7);  // two roundings to float of coordinates of 0.1 m
      touching += gap < 1e-4 ? 1 : 0;
    }
    EXPECT_GT(touching, 0);
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
          glm::distance(drawn.moved(v), drawn.world.tools.at<ToolPose>(0).now.position) - 0.05;
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
  drawn.world.regions.at<RegionFriction>(0).stick_turn = 0.3;
  drawn.world.regions.at<RegionFriction>(0).stick_radius = 0.01;
  drawn.world.regions.at<RegionMotion>(0).axis_share = 1.0;
  drawn.world.regions.at<RegionMotion>(0).axis = kUp;
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
    const double mean = drawn.world.regions.at<RegionNormal>(0).force /
                        drawn.world.regions.at<RegionGeometry>(0).area;
    EXPECT_NEAR(static_cast<double>(pressure - before), 0.0, 0.02 * mean);
  }
}

TEST(SurfaceFieldTest, SharesOfTheAxisBlendWithoutAJump) {
  double before = 0.0;
  for (int i = 0; i <= 100; ++i) {
    Drawn drawn(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 2));
    const std::uint32_t region = twisting_region(drawn.world, 0.3, 0.01, 0.02);
    drawn.world.regions.at<RegionMotion>(region).axis_share = i / 100.0;
    drawn.world.regions.at<RegionWrench>(region).on_tool.torque = -0.5 * kUp;
    drawn.world.tools.at<ToolMotion>(0).axis_turn = 1.0;
    drawn.world.tools.at<ToolMotion>(0).mass_center = glm::dvec3(0.02, 0.1, 0.0);
    capture(drawn.world, drawn.snapshot);
    const RegionTwist twist = region_twist(drawn.world, drawn.snapshot, region);
    const double angle = twist.angle({0.03, 0.05, 0.02});
    if (i > 0) {
      EXPECT_NEAR(angle, before, 0.005);
    }
    before = angle;
  }
}

TEST(SurfaceFieldTest, RegionsKeepTheirSlotsInTheOrderOfFormation) {
  Drawn drawn = cube();
  twisting_region(drawn.world, 0.1, 0.01, 0.02);
  twisting_region(drawn.world, 0.2, 0.01, 0.02);
  drawn.draw();
  ASSERT_EQ(drawn.frame.bodies.at<FrameBody>(0).regions_drawn, 2U);
  const std::uint32_t v = 4 * 21 * 21 + 10 * 21 + 10;  // the middle of the top face
  ASSERT_NEAR(glm::distance(drawn.rest(v), glm::dvec3(0.0, 0.05, 0.0)), 0.0, 1e-6);
  EXPECT_NEAR(drawn.twist(0, v), 0.1, 1e-6);
  EXPECT_NEAR(drawn.twist(1, v), 0.2, 1e-6);
  EXPECT_NEAR(static_cast<double>(drawn.positions[v].w), 0.3, 1e-6);  // the same axis: angles add
}

TEST(SurfaceFieldTest, BodyWithoutContactIsDrawnAtRest) {
  Drawn drawn = cube();
  twisting_region(drawn.world, 0.1, 0.01, 0.02);
  drawn.draw();
  drawn.world.regions.clear();
  drawn.draw();
  EXPECT_EQ(drawn.frame.bodies.at<FrameBody>(0).regions_drawn, 0U);
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    EXPECT_EQ(glm::vec3(drawn.positions[v]),
              glm::vec3(drawn.frame.body_vertices.at<VertexRest>(v).position));
  }
}

TEST(SurfaceFieldTest, ToolsAreDrawnWhereTheSnapshotHasThem) {
  Drawn drawn = cube();
  drawn.world.tools.at<ToolPose>(0).now = {glm::dvec3(1.0, 2.0, 3.0),
                                           glm::dquat(0.6, 0.8, 0.0, 0.0)};
  drawn.draw();
  EXPECT_EQ(drawn.frame.tools.at<Pose>(0).position, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(drawn.frame.tools.at<Pose>(0).rotation, glm::dquat(0.6, 0.8, 0.0, 0.0));
}

TEST(DeformVerticesTest, MatchesRotationsInDoublePrecision) {
  Drawn drawn = cube();
  FrameBody& data = drawn.frame.bodies.at<FrameBody>(0);
  data.regions_drawn = 3;
  const auto axes = drawn.frame.axes.rows<TwistAxis>(data.axes);
  for (std::uint32_t slot = 0; slot < 3; ++slot) {
    const double i = slot;
    axes[slot].point = glm::vec4(0.01 * i, 0.02, -0.03, 0.0);
    axes[slot].direction =
        glm::vec4(glm::normalize(glm::vec3(1.0F, 0.5F - static_cast<float>(i), 0.3F)), 0.0F);
  }
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    for (std::uint32_t slot = 0; slot < 3; ++slot) {
      drawn.frame.twist.at<TwistAngle>(slot * drawn.vertices() + v).angle =
          static_cast<float>(std::sin(0.1 * v + slot) * 8.0);
    }
    drawn.frame.body_vertices.at<VertexDisplacement>(v).displacement =
        glm::vec4(0.001F, -0.002F, 0.003F, 5.0F);
  }
  drawn.positions.resize(drawn.vertices());
  deform_vertices(drawn.frame, 0, drawn.positions);
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    glm::dvec3 x = drawn.rest(v);
    for (std::uint32_t slot = 0; slot < 3; ++slot) {
      const glm::dvec3 point(axes[slot].point);
      x = point +
          glm::angleAxis(drawn.twist(slot, v), glm::dvec3(axes[slot].direction)) * (x - point);
    }
    x += glm::dvec3(0.001F, -0.002F, 0.003F);
    // Three turns of points within 0.2 m: each rounds a few times to 6e-8 of that.
    EXPECT_NEAR(glm::distance(drawn.moved(v), x), 0.0, 3e-7);
  }
}

}  // namespace
}  // namespace torsion
