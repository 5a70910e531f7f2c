// Contacts that reach over a body's edges, where the body's side is nearer than the face that the
// tool presses on.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/paper/paper.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;
using test::kUpright;

constexpr double kHalfWidth = 0.03;  // m, of the body along the rod
constexpr double kRodRadius = 0.012;

/// A rod that lies across a block from edge to edge and beyond; the block's top is y = 0.
SceneDescription rod_on_block() {
  SceneDescription scene;
  scene.bodies.push_back(test::make_body({test::make_part(
      ShapeKind::kBox, {kHalfWidth, 0.03, 0.03}, {glm::dvec3(0.0, -0.03, 0.0), kUpright})}));
  scene.bodies[0].models.body = BodyModel::kNone;
  scene.bodies[0].models.region_threshold = 0.02;
  const glm::dquat along_x = glm::angleAxis(0.5 * 3.14159265358979, glm::dvec3(0.0, 0.0, 1.0));
  scene.tools.push_back(test::make_tool({test::make_part(
      ShapeKind::kCapsule, {kRodRadius, 0.08, kRodRadius}, {glm::dvec3(0.0), along_x})}));
  return scene;
}

TEST(BodyEdgesTest, ARodAcrossABlockPressesOnItsTopFromEdgeToEdge) {
  Hand hand(rod_on_block());
  const double depth = 1.5e-3;
  hand.step_to({{glm::dvec3(0.0, kRodRadius + 1e-4, 0.0), kUpright}});
  hand.move({0.0, -depth - 1e-4, 0.0}, kUp, 0.0, 100);
  hand.move({0.0, 0.0, 0.0}, kUp, 0.0, 20);  // what faded in at birth is over
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  const Overlap& overlap = hand.world().state.regions.at<Overlap>(0);
  const double half_strip = std::sqrt(2.0 * kRodRadius * depth - depth * depth);
  const double area = 4.0 * kHalfWidth * half_strip;
  // The ends of the strip lie between cells of 4 mm; across, 16 cells resolve it to 0.5 %.
  EXPECT_NEAR(overlap.area / area, 1.0, 0.02);
  // The mean over the chord of a circle: (segment's area) / chord.
  const double angle = std::acos(1.0 - depth / kRodRadius);
  const double segment = kRodRadius * kRodRadius * (angle - 0.5 * std::sin(2.0 * angle));
  EXPECT_NEAR(overlap.mean_depth / (segment / (2.0 * half_strip)), 1.0, 0.02);
  EXPECT_NEAR(overlap.largest_depth / depth, 1.0, 0.02);
  // Cells are on the rod within 1e-6 of their length.
  EXPECT_NEAR(glm::distance(overlap.mean_normal, kUp), 0.0, 1e-6);
  EXPECT_NEAR(glm::length(glm::dvec2(overlap.rest_center.x, overlap.rest_center.z)), 0.0, 1e-4);
  const double stiffness =
      paper_normal_law(4e6, std::sqrt(area / 3.14159265358979), 0.0, 0.0).linear;
  EXPECT_NEAR(hand.wrench().force.y / (stiffness * overlap.mean_depth), 1.0, 0.02);
}

TEST(BodyEdgesTest, ForceFollowsThePressWithoutJumps) {
  Hand hand(rod_on_block());
  hand.step_to({{glm::dvec3(0.0, kRodRadius + 1e-4, 0.0), kUpright}});
  hand.move({0.0, -5e-4, 0.0}, kUp, 0.0, 100);
  double before = hand.wrench().force.y;
  for (int i = 0; i < 400; ++i) {
    hand.move({2e-6, -4e-6, 1e-6}, kUp, 0.0, 1);
    const double force = hand.wrench().force.y;
    // Force goes as depth^1.25 for a rod (k1 as the root of the area): 4 um of at least 0.4 mm are
    // 1.3 %; a column of cells that comes or goes at an edge would be 6 %.
    EXPECT_GT(force, before * 0.995);
    EXPECT_LT(force, before * 1.02);
    before = force;
  }
}

/// The rod pressed in, then tilted about the middle of the line that it presses, in equal steps.
struct Tilting {
  std::vector<double> place;  // m: along the rod, of its force, after each step
  std::vector<double> force;  // N: upwards
};

constexpr double kTiltDepth = 1.5e-3;  // m
constexpr double kTiltStep = 1e-4;     // rad

Tilting tilt_rod(ContactModel model, int steps) {
  SceneDescription scene = rod_on_block();
  scene.bodies[0].models.contact = model;
  Hand hand(scene);
  hand.step_to({{glm::dvec3(0.0, kRodRadius + 1e-4, 0.0), kUpright}});
  hand.move({0.0, -kTiltDepth - 1e-4, 0.0}, kUp, 0.0, 50);
  const glm::dvec3 lowest(0.0, -kTiltDepth, 0.0);
  Tilting tilting;
  for (int i = 0; i <= steps; ++i) {
    const glm::dquat turn = glm::angleAxis(kTiltStep * i, glm::dvec3(0.0, 0.0, 1.0));
    hand.step_to({{lowest + turn * glm::dvec3(0.0, kRodRadius, 0.0), turn}});
    const glm::dvec3 arm = hand.world().state.tools.at<ToolMotion>(0).mass_center - lowest;
    const Wrench& wrench = hand.wrench();
    tilting.force.push_back(wrench.force.y);
    tilting.place.push_back((wrench.torque + glm::cross(arm, wrench.force)).z / wrench.force.y);
  }
  return tilting;
}

// A flat contact that tilts has no apex. A force that ran to its ends with the last digits of a
// fitted curvature (it did) would let a held rod shake.
TEST(BodyEdgesTest, ATiltedRodShiftsItsForceAsAStampDoes) {
  constexpr int kSteps = 200;  // to 0.02 rad: the rod's end lifts at 0.05
  const Tilting mdr = tilt_rod(ContactModel::kMdr, kSteps);
  const Tilting patch = tilt_rod(ContactModel::kPatch, kSteps);
  // On Winkler's foundation a cylinder of length 2 L, d deep, carries d^1.5 along its length, and
  // the force of it goes by 1.5 L^2 / (3 d) a radian; a half-space's is a little stiffer. No cell
  // that comes or goes may add a step of its own of more than half of it.
  const double slope = 2.0 * kHalfWidth * kHalfWidth / (3.0 * kTiltDepth);
  for (int i = 1; i <= kSteps; ++i) {
    const auto now = static_cast<std::size_t>(i);
    const double moved = mdr.place[now - 1] - mdr.place[now];
    EXPECT_GT(moved, 0.5 * slope * kTiltStep) << i;
    EXPECT_LT(moved, 1.5 * slope * kTiltStep) << i;
  }
  // One factor stands for all lengths: Winkler's foundation, which an endless rod has, is 3/4 of
  // it, and a rod five times as long as its contact is wide 1.04 of it.
  EXPECT_NEAR((mdr.place.front() - mdr.place.back()) / (patch.place.front() - patch.place.back()),
              1.0, 0.25);
  // Hertz' strip between two edges, without what the edges add or take: 10 % of patch's.
  EXPECT_NEAR(mdr.force.front() / patch.force.front(), 1.0, 0.1);
  EXPECT_NEAR(mdr.force.back() / patch.force.back(), 1.0, 0.1);
}

TEST(BodyEdgesTest, ARodHeldOnABodyThatGivesWayComesToRest) {
  for (const ContactModel model : {ContactModel::kMdr, ContactModel::kPaper}) {
    SceneDescription scene = rod_on_block();
    scene.bodies[0].models.contact = model;
    scene.bodies[0].models.body = BodyModel::kCompliance;
    Hand hand(scene);
    hand.step_to({{glm::dvec3(0.0, kRodRadius + 1e-4, 0.0), kUpright}});
    hand.move({2e-4, -kTiltDepth, 3e-4}, kUp, 0.0, 100);
    hand.move(glm::dvec3(0.0), {0.0, 0.0, 1.0}, 0.01, 50);
    hand.move(glm::dvec3(0.0), kUp, 0.0, 200);
    const glm::dvec3 before = hand.wrench().force;
    EXPECT_GT(before.y, 1.0);
    for (int i = 0; i < 20; ++i) {
      hand.move(glm::dvec3(0.0), kUp, 0.0, 1);
      // Newton's method on a stiffness that is known within a half halves what is left each step:
      // 200 steps leave rounding.
      EXPECT_LT(glm::distance(hand.wrench().force, before), 1e-6 * before.y);
    }
  }
}

// Inside a body the distance to its surface has a kink where two faces are as near as each other.
// Steepest descent along the tool's surface ended there, before it came to the deepest point.
TEST(BodyEdgesTest, AToolBesideAnEdgeIsFoundWhereverItsSamplesAre) {
  constexpr double kRadius = 0.012;
  constexpr double kBeside = 0.3;
  // A descent along a kink ends where that falls by 1 in 20: for a ball a twentieth of its radius
  // from the deepest point, which is deeper by half the square.
  constexpr double kMostMissed = 0.5 * 0.05 * 0.05 * kRadius;
  const double over = std::sqrt(1.0 - kBeside * kBeside);
  for (int place = 0; place < 40; ++place) {
    SceneDescription scene = rod_on_block();
    scene.tools[0] = test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(kRadius))});
    Hand hand(scene);
    const glm::dvec3 touching(kHalfWidth + kBeside * kRadius, over * kRadius, 5e-4 * place);
    hand.step_to({{touching + kMostMissed * kUp,
                   glm::angleAxis(0.05 * place, glm::normalize(glm::dvec3(0.2, 0.4, 1.0)))}});
    hand.move({0.0, -2.0 * kMostMissed, 0.0}, kUp, 0.0, 30);
    EXPECT_EQ(hand.world().state.regions.size(), 1U) << place;
  }
}

/// Of a ball's force that answers its approach to an edge of the block, from `angle` beside the
/// top's normal in the plane across the edge, along that way, without friction: its share along
/// the way.
/// @param as_mesh  ball and block are meshes
double along_approach(ContactModel contact, double angle, double depth, bool as_mesh) {
  constexpr double kRadius = 0.012;
  SceneDescription scene = rod_on_block();
  scene.bodies[0].parts = {test::make_part(ShapeKind::kBox, {kHalfWidth, 0.03, 0.03},
                                           {glm::dvec3(0.0, -0.03, 0.0), kUpright}, as_mesh)};
  scene.tools[0] =
      test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(kRadius), {}, as_mesh)});
  scene.bodies[0].friction = {0.0, 0.0};
  scene.bodies[0].models.contact = contact;
  Hand hand(scene);
  const glm::dvec3 outwards(std::sin(angle), std::cos(angle), 0.0);
  const glm::dvec3 edge(kHalfWidth, 0.0, 0.0);
  hand.step_to({{edge + (kRadius + 1e-5) * outwards, kUpright}});
  hand.move(-(depth + 1e-5) * outwards, kUp, 0.0, 50);
  hand.move({0.0, 0.0, 0.0}, kUp, 0.0, 20);  // what faded in at birth is over
  const glm::dvec3 force = hand.wrench().force;
  EXPECT_GT(glm::length(force), 0.0);
  return glm::dot(force, outwards) / glm::length(force);
}

// A ball that meets the edge between top and side: the two faces are as near as each other where it
// is deepest, but it leaves by the one that it comes to more straight on, whose normal is within 45
// degrees of its way.
TEST(BodyEdgesTest, ABallThatMeetsAnEdgeIsCarriedByTheFaceThatItPressesOn) {
  constexpr double kShare = 0.5 * std::numbers::sqrt2;
  for (const ContactModel contact :
       {ContactModel::kPaper, ContactModel::kMdr, ContactModel::kPatch, ContactModel::kWinkler}) {
    for (const double angle : {0.1, 0.3, 0.5, 0.7, 0.87, 1.07, 1.27, 1.47}) {
      for (const double depth : {3e-5, 5e-4}) {
        EXPECT_GT(along_approach(contact, angle, depth, false), kShare)
            << static_cast<int>(contact) << " " << angle << " " << depth;
      }
    }
  }
  for (const ContactModel contact : {ContactModel::kMdr, ContactModel::kPatch}) {
    for (const double angle : {0.1, 0.5, 1.07, 1.47}) {
      EXPECT_GT(along_approach(contact, angle, 5e-4, true), kShare)
          << static_cast<int>(contact) << " " << angle << " as meshes";
    }
  }
}

}  // namespace
}  // namespace torsion::engine
