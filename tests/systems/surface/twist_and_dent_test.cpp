#include "systems/surface/twist_and_dent.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/systems/surface/drawn_body.hpp"

namespace torsion::engine {
namespace {

TEST(RegionTwistTest, AnglesAreThePapersThroughTheRegion) {
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

TEST(RegionTwistTest, ADeepContactTurnsTheRestSurfaceByAllOfTheAngle) {
  // 20 mm deep in a body of 100 mm: heights are those of the rest shape, 1 at the contact.
  Drawn drawn = cube();
  const std::uint32_t region =
      add_region(drawn.world, {.point = {0.0, 0.05, 0.0}, .radius = 0.02, .depth = 0.02});
  RegionMotion& motion = drawn.world.state.regions.at<RegionMotion>(region);
  motion.axis = kUp;
  motion.axis_share = 1.0;
  RegionFriction& friction = drawn.world.state.regions.at<RegionFriction>(region);
  friction.stick_turn = 0.4;
  friction.stick_radius = 0.02;
  capture(drawn.world.model, drawn.world.state, drawn.snapshot);
  const RegionTwist twist = region_twist(drawn.world.model, drawn.snapshot, region);
  EXPECT_NEAR(twist.angle({0.0, 0.05, 0.01}), 0.4, 1e-12);
  EXPECT_NEAR(twist.angle({0.0, 0.04, 0.01}), 0.4 * 0.9, 1e-12);
  EXPECT_NEAR(twist.angle({0.0, 0.0, 0.01}), 0.2, 1e-12);
}

TEST(RegionTwistTest, PositiveAnglesTurnCounterClockwiseSeenFromOutside) {
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

TEST(RegionTwistTest, OppositeTurnsGiveMirroredShapes) {
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

TEST(RegionTwistTest, NothingBehindTheFixedPointTurns) {
  // Pressed from the side: what lies beyond the plane through the fixed point keeps its place.
  Drawn drawn(exact_body(ShapeKind::kEllipsoid, {0.06, 0.04, 0.05}, FixedKind::kPoint, 10));
  const std::uint32_t region = add_region(
      drawn.world, {.point = {0.06, 0.0, 0.0}, .normal = {1.0, 0.0, 0.0}, .radius = 0.01});
  drawn.world.state.regions.at<RegionMotion>(region).axis_share = 1.0;
  drawn.world.state.regions.at<RegionMotion>(region).axis = glm::dvec3(1.0, 0.0, 0.0);
  drawn.world.state.regions.at<RegionFriction>(region).stick_turn = 0.5;
  drawn.world.state.regions.at<RegionFriction>(region).stick_radius = 0.01;
  drawn.draw();
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    if (drawn.rest(v).x <= 0.0) {
      EXPECT_EQ(drawn.twist(0, v), 0.0);
    }
  }
}

TEST(RegionTwistTest, TorqueOfAnAxisThatMissesTheRegionTwistsBarsAsSaintVenantSays) {
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
    drawn.world.state.regions.at<RegionMotion>(region).axis = kUp;
    drawn.world.state.regions.at<RegionWrench>(region).on_tool.torque = -bar.torque * kUp;
    drawn.world.state.over(0, 0).axis = kUp;
    drawn.world.state.over(0, 0).axis_turn = 0.02;  // what is remembered of a long turn
    drawn.world.state.over(0, 0).center = glm::dvec3(0.0, 0.3, 0.0);
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

TEST(RegionTwistTest, TorqueAgainstTheAxisTurnsTheSameWayAsAlongTheFlippedAxis) {
  double turns[2] = {};
  for (int i = 0; i < 2; ++i) {
    Drawn drawn = cube();
    const glm::dvec3 axis = i == 0 ? kUp : -kUp;
    const std::uint32_t region =
        add_region(drawn.world, {.point = {0.0, 0.05, 0.0}, .radius = 0.005});
    drawn.world.state.regions.at<RegionMotion>(region).axis = axis;
    drawn.world.state.regions.at<RegionWrench>(region).on_tool.torque = -0.1 * kUp;
    drawn.world.state.over(0, 0).axis = axis;
    drawn.world.state.over(0, 0).axis_turn = 0.02;
    drawn.draw();
    const std::uint32_t v = 4 * 21 * 21;  // a corner of the top face
    ASSERT_NEAR(drawn.rest(v).y, 0.05, 1e-9);
    turns[i] = glm::dot(glm::cross(drawn.rest(v), drawn.moved(v)), kUp);
  }
  EXPECT_GT(turns[0], 0.0);
  EXPECT_NEAR(turns[0], turns[1], 1e-9);
}

TEST(RegionTwistTest, SharesOfTheAxisBlendWithoutAJump) {
  Drawn drawn(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 2));
  const std::uint32_t region = twisting_region(drawn.world, 0.3, 0.01, 0.02);
  drawn.world.state.regions.at<RegionWrench>(region).on_tool.torque = -0.5 * kUp;
  drawn.world.state.over(0, 0).axis_turn = 0.02;
  drawn.world.state.over(0, 0).center = glm::dvec3(0.02, 0.1, 0.0);
  double before = 0.0;
  for (int i = 0; i <= 100; ++i) {
    drawn.world.state.regions.at<RegionMotion>(region).axis_share = i / 100.0;
    capture(drawn.world.model, drawn.world.state, drawn.snapshot);
    const RegionTwist twist = region_twist(drawn.world.model, drawn.snapshot, region);
    const double angle = twist.angle({0.03, 0.05, 0.02});
    if (i > 0) {
      EXPECT_NEAR(angle, before, 0.005);
    }
    before = angle;
  }
}

TEST(RegionTwistTest, ARegionWithoutAFieldTurnsNothing) {
  Drawn drawn = cube();
  drawn.world.model.bodies.at<BodyModels>(0).contact = ContactModel::kPatch;
  const std::uint32_t region =
      add_region(drawn.world, {.point = {0.0, 0.05, 0.0}, .radius = 0.01, .depth = 0.001});
  RegionFriction& friction = drawn.world.state.regions.at<RegionFriction>(region);
  friction.stick_turn = 0.3;
  friction.stick_radius = 0.01;
  drawn.world.state.regions.at<RegionMotion>(region).axis = kUp;
  drawn.world.state.regions.at<RegionMotion>(region).axis_share = 1.0;
  capture(drawn.world.model, drawn.world.state, drawn.snapshot);
  const RegionTwist twist = region_twist(drawn.world.model, drawn.snapshot, region);
  EXPECT_EQ(twist.angle({0.002, 0.05, 0.0}), 0.0);
  EXPECT_NEAR(glm::length(glm::vec3(twist.axis.direction)), 1.0F, 1e-6F);
}

TEST(RegionTwistTest, RegionsKeepTheirSlotsInTheOrderOfFormation) {
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

}  // namespace
}  // namespace torsion::engine
