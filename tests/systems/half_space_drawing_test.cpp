#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/contact_models/region_fields.hpp"
#include "systems/region_field.hpp"
#include "systems/turn_vertex.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/reissner_sagoci.hpp"
#include "tests/systems/pressed_ball.hpp"

namespace torsion {
namespace {

using test::BallScene;
using test::PressedBall;

constexpr double kRadius = 0.004;  // m
constexpr double kShear = 2e5;     // Pa

/// Discs around z at the origin.
TurnedDiscs discs_with(const std::array<double, kFieldDiscs>& turn) {
  TurnedDiscs discs;
  discs.normal = {0.0, 0.0, 1.0};
  discs.radius = kRadius;
  discs.turn = turn;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    discs.far_turn += 4.0 / (3.0 * M_PI) *
                      std::pow(kRadius * static_cast<double>(j + 1) / kFieldDiscs, 3.0) * turn[j];
  }
  return discs;
}

TEST(HalfSpaceDrawingTest, OneDiscTurnsTheBodyAsReissnerAndSagociSay) {
  std::array<double, kFieldDiscs> turn{};
  turn.back() = 1.0;
  const TurnedDiscs discs = discs_with(turn);
  for (const double r : {0.0, 0.3, 0.99, 1.2, 2.0, 2.8}) {
    for (const double z : {0.0, 0.2, 0.9}) {
      const double exact = reference::bonded_disc_twist_ratio(kRadius, r * kRadius, z * kRadius);
      EXPECT_NEAR(discs.angle({r * kRadius, 0.0, -z * kRadius}), exact, 1e-12) << r << ' ' << z;
    }
  }
  // Beyond three radii it goes over to the far field, which is off by 9/10 (a/R)^2 in the plane.
  for (const double r : {3.5, 4.0, 6.0, 20.0}) {
    const double exact = reference::bonded_disc_twist_ratio(kRadius, r * kRadius, 0.0);
    EXPECT_NEAR(discs.angle({0.0, r * kRadius, 0.0}) / exact, 1.0, 1.0 / (r * r)) << r;
  }
}

TEST(HalfSpaceDrawingTest, DiscsCarryTheCouplesTheyWereMadeFor) {
  // Couples of the rings of two bonded discs, in closed form by quadrature of their traction.
  const std::array<double, kFieldDiscs> wanted{0.0, 0.02, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.03};
  std::array<double, kFieldDiscs> couples{};
  for (std::size_t disc = 0; disc < kFieldDiscs; ++disc) {
    const double s = kRadius * static_cast<double>(disc + 1) / kFieldDiscs;
    constexpr int kPieces = 20000;
    for (int piece = 0; piece < kPieces; ++piece) {
      // r = s sin(t) takes the singularity at the rim away.
      const double t = M_PI_2 * (piece + 0.5) / kPieces;
      const double r = s * std::sin(t);
      const double slice =
          8.0 * kShear * wanted[disc] * r * r * r * M_PI_2 / kPieces;  // tau 2 pi r^2 dr
      couples[std::min(static_cast<std::size_t>(r / kRadius * kFieldDiscs),
                       std::size_t{kFieldDiscs - 1})] += slice;
    }
  }
  std::array<double, kFieldDiscs> turn{};
  discs_of_ring_couples(couples, kRadius, kShear, turn);
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    EXPECT_NEAR(turn[j], wanted[j], 1e-4) << j;
  }
}

TEST(HalfSpaceDrawingTest, PressedBlocksSinkLikeHertzAroundTheContact) {
  const double modulus = 4.0 * kShear;  // nu = 0.5
  const auto hertz = reference::hertz_sphere_at_depth(0.05, modulus, 4e-4);
  PressedSurface pressed;
  pressed.normal = {0.0, 0.0, 1.0};
  pressed.radius = hertz.radius;
  pressed.spread = 0.28 * 2.0 / kFieldBlocks * hertz.radius;
  pressed.shear_modulus = kShear;
  pressed.poisson_ratio = 0.5;
  constexpr int kSide = kFieldBlocks;
  double sum = 0.0;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const glm::dvec3 place = hertz.radius * glm::dvec3((2.0 * i + 1.0) / kSide - 1.0,
                                                         (2.0 * j + 1.0) / kSide - 1.0, 0.0);
      const double pressure = reference::hertz_pressure(hertz, glm::length(place));
      if (pressure > 0.0) {
        pressed.forces[pressed.count++] = {place, {0.0, 0.0, -pressure}};
        sum += pressure;
      }
    }
  }
  for (auto& each : pressed.forces) {
    each.force *= hertz.force / sum;
  }
  pressed.all.force = {0.0, 0.0, -hertz.force};
  // Outside the contact; the blocks' middles have 3 % less second moment than the pressure.
  for (const double r : {1.2, 1.5, 2.0, 3.0, 3.5, 4.5, 10.0}) {
    const double exact = reference::hertz_surface_displacement(hertz, r * hertz.radius);
    const glm::dvec3 moved = pressed.displacement({r * hertz.radius, 0.0, 0.0});
    EXPECT_NEAR(-moved.z / exact, 1.0, 0.03) << r;
    EXPECT_NEAR(moved.x, 0.0, 1e-9) << r;  // nothing moves sideways at nu = 0.5
  }
  EXPECT_NEAR(-pressed.displacement(glm::dvec3(0.0)).z / hertz.depth, 1.0, 0.1);
}

/// Points near and far from the origin, above and below the surface, that fill a block.
BlockVectors points_around() {
  BlockVectors points{};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const double reach = kRadius * std::pow(30.0, static_cast<double>(i) / kPointBlock - 0.1);
    points.set(i, reach * glm::dvec3(normal(random), normal(random), normal(random)));
  }
  return points;
}

// A block does in float what single points get in double: a few dozen roundings of 6e-8.
TEST(HalfSpaceDrawingTest, BlocksOfPointsGetWhatSinglePointsGet) {
  const BlockVectors points = points_around();
  std::array<double, kFieldDiscs> turn{};
  turn.fill(0.02);
  const TurnedDiscs discs = discs_with(turn);
  PressedSurface pressed;
  pressed.normal = {0.0, 0.0, 1.0};
  pressed.radius = kRadius;
  pressed.spread = 0.1 * kRadius;
  pressed.shear_modulus = kShear;
  pressed.poisson_ratio = 0.3;
  pressed.share = 0.7;
  for (int i = 0; i < 9; ++i) {
    const glm::dvec3 place(i % 3 - 1, i / 3 - 1, 0.0);
    pressed.forces[pressed.count] = {0.5 * kRadius * place, {0.3, -0.1, -1.0 + 0.05 * i}};
    pressed.all.force += pressed.forces[pressed.count++].force;
  }
  BlockColumn angles{};
  BlockVectors moved{};
  discs.angles(points, kPointBlock, angles);
  pressed.add_displacements(points, kPointBlock, moved);
  const double deepest = glm::length(pressed.displacement(glm::dvec3(0.0)));
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    EXPECT_NEAR(static_cast<double>(angles[i]), discs.angle(points.at(i)), 2e-6 * 0.2);
    EXPECT_NEAR(glm::distance(moved.at(i), pressed.displacement(points.at(i))), 0.0,
                2e-6 * deepest);
  }
}

TEST(HalfSpaceDrawingTest, ABlockTurnsToTheBitsOfSingleVertices) {
  const TwistAxis axis{glm::vec4(0.001F, -0.02F, 0.003F, 0.0F),
                       glm::vec4(glm::normalize(glm::vec3(0.3F, 1.0F, -0.2F)), 0.0F)};
  // The second block has turns beyond a quarter.
  for (const float largest : {1.5F, 8.0F}) {
    BlockVectors points = points_around();
    const BlockVectors before = points;
    BlockColumn angles{};
    for (std::size_t i = 0; i < kPointBlock; ++i) {
      angles[i] = largest * std::sin(static_cast<float>(i));
    }
    turn_block(axis, angles, points);
    for (std::size_t i = 0; i < kPointBlock; ++i) {
      const glm::vec3 one = turn_vertex({before.x[i], before.y[i], before.z[i]}, axis, angles[i]);
      EXPECT_EQ(glm::vec3(points.x[i], points.y[i], points.z[i]), one);
    }
  }
}

/// Twist of the surface over that of the tool at distances of the axis, after a twist of 0.05 rad
/// with partial slip, against Lubkin's superposition.
void expect_field_of_lubkin(ContactModel model, std::uint32_t side, double bound) {
  BallScene scene;
  scene.model = model;
  scene.side = side;
  PressedBall ball(scene);
  constexpr double kTwist = 0.05;
  ball.press(test::kBallDepth, 200);
  ball.twist(kTwist, 400);
  ball.twist(0.0, 16);  // the sums for drawing are made anew every few steps
  const RegionField& field = ball.hand.world().regions.at<RegionField>(0);
  TurnedDiscs discs;
  discs.normal = {0.0, 0.0, 1.0};
  discs.radius = field.radius;
  std::copy(std::begin(field.turn), std::end(field.turn), discs.turn.begin());
  const reference::LubkinContact exact = ball.lubkin();
  for (const double share : {0.05, 0.3, 0.6, 0.9, 1.1, 1.3, 1.6, 2.0, 2.8}) {
    const double r = share * exact.radius;
    const double expected = reference::twist_displacement(exact, kTwist, r) / r;
    EXPECT_NEAR(discs.angle({r, 0.0, 0.0}) / kTwist, expected / kTwist, bound) << share;
  }
}

// Ten discs stand for the exact field's continuum of them: the angle between two of them is off by
// up to a tenth of what it falls from one to the next, which is 0.3 at the rim. The cells' ring
// couples add their own error.
TEST(HalfSpaceDrawingTest, SurfaceTurnsAsLubkinSaysUnderMdr) {
  expect_field_of_lubkin(ContactModel::kMdr, 12, 0.06);
}

TEST(HalfSpaceDrawingTest, SurfaceTurnsAsLubkinSaysUnderPatch) {
  expect_field_of_lubkin(ContactModel::kPatch, 16, 0.08);
}

}  // namespace
}  // namespace torsion
