#include <numbers>

#include <gtest/gtest.h>

#include "tests/reference/paper_shaft.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using reference::PaperShaft;
using test::Hand;
using test::kUp;

constexpr double kDeep = 8e-4;     // m
constexpr double kShallow = 4e-4;  // m: the disc's radius is deep's over the square root of 2

Hand ball_at(double depth) {
  Hand hand(test::ball_on_cube());
  hand.step_to({{glm::dvec3(0.0, 0.15 + 1e-4, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move(glm::dvec3(0.0, -1e-4 - depth, 0.0), kUp, 0.0, 200);
  return hand;
}

/// A turn that no cell slips at, neither now nor at half the depth.
double small_turn(const Hand& hand) {
  const World& world = hand.world();
  const PaperShaft shaft{world.state.regions.at<RegionNormal>(0).force,
                         world.model.bodies.at<Friction>(0).dynamic_friction,
                         world.model.bodies.at<Elasticity>(0).shear_modulus(),
                         world.state.regions.at<Contact>(0).radius,
                         world.state.regions.at<RegionMotion>(0).lever};
  return 0.2 * shaft.yield_turn();
}

double radius_of(const Hand& hand) {
  return hand.world().state.regions.at<Contact>(0).radius;
}

TEST(CarryTractionsTest, ShrinkingContactLosesTheTractionOfTheAreaItLeaves) {
  Hand hand = ball_at(kDeep);
  hand.move(glm::dvec3(0.0), kUp, small_turn(hand), 50);
  const double before = hand.wrench().torque.y;
  const double radius_before = radius_of(hand);
  hand.move(glm::dvec3(0.0, kDeep - kShallow, 0.0), kUp, 0.0, 400);
  // tau = G r phi / l stays in what is left: the torque is that of the smaller disc, T ~ a^4. Two
  // hundred cells resolve a fourth moment within about 2 %, and carrying them over blurs as much.
  const double expected = before * std::pow(radius_of(hand) / radius_before, 4);
  EXPECT_NEAR(hand.wrench().torque.y, expected, 0.04 * std::abs(expected));
}

TEST(CarryTractionsTest, GrowingContactGetsNewAreaWithoutTraction) {
  Hand hand = ball_at(kShallow);
  hand.move(glm::dvec3(0.0), kUp, small_turn(hand), 50);
  const double before = hand.wrench().torque.y;
  hand.move(glm::dvec3(0.0, kShallow - kDeep, 0.0), kUp, 0.0, 400);
  // Nothing turned since: the torque stays. But the edge of what is twisted wanders over d = 3 of
  // 7 cells, blurs by d h^2 / 2 each way (linear interpolation at many small steps), and a blur of
  // variance s^2 raises the moment of a profile ~ r by 4 s^2 / a^2: 4 * 1.5 / 7^2 = 12 %.
  EXPECT_NEAR(hand.wrench().torque.y, before, 0.16 * std::abs(before));
  EXPECT_LE(hand.wrench().torque.y, before);  // it opposes the turn
}

TEST(CarryTractionsTest, StillContactKeepsItsTractions) {
  Hand hand = ball_at(kDeep);
  hand.move(glm::dvec3(0.0), kUp, small_turn(hand), 50);
  const auto cells = hand.world().state.regions.at<RegionIdentity>(0).cells;
  const auto rows = hand.world().state.cells.rows<CellTraction>(cells);
  const std::vector<CellTraction> before(rows.begin(), rows.end());
  hand.move(glm::dvec3(0.0), kUp, 0.0, 100);
  for (std::size_t i = 0; i < before.size(); ++i) {
    // The grid breathes by rounding errors.
    EXPECT_LT(glm::distance(rows[i].traction, before[i].traction),
              1e-9 * glm::length(before[i].traction) + 1e-9);
  }
}

TEST(CarryTractionsTest, SlidingContactIsAtItsLimitAgainstTheMotion) {
  // The grid follows over many times its size: what it carries must not outlive the place.
  Hand hand = ball_at(kDeep);
  hand.move(glm::dvec3(0.02, 0.0, 0.0), kUp, 0.0, 400);
  const World& world = hand.world();
  const double limit = world.model.bodies.at<Friction>(0).static_friction *
                       world.state.regions.at<RegionNormal>(0).force;
  // Sliding along x: all of the friction is along -x, of the full size.
  EXPECT_NEAR(hand.wrench().force.x, -limit, 0.02 * limit);
  EXPECT_LT(std::abs(hand.wrench().force.z), 0.01 * limit);
}

TEST(CarryTractionsTest, LongContactThatSticksTurnsWithItsMaterial) {
  // A lying capsule on a slab with so much friction that nothing slips. The patch is twice as long
  // as wide; on a body that is flat and held by a face it stays so, and tau = G r phi / l is linear
  // in phi: ten times the turn is ten times the torque. Were the patch to wander over its material,
  // it would lose what its ends hold.
  SceneDescription scene;
  scene.bodies.push_back(
      test::make_body({test::make_part(ShapeKind::kBox, {0.15, 0.05, 0.15},
                                       {glm::dvec3(0.0, -0.05, 0.0), glm::dquat(1, 0, 0, 0)})}));
  scene.bodies[0].fixed = {FixedKind::kFace, 0, {0.0, -0.1, 0.0}, {0.0, 1.0, 0.0}, {}};
  scene.bodies[0].friction = {50.0, 50.0};
  const glm::dquat lying = glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(0.0, 0.0, 1.0));
  scene.tools.push_back(test::make_tool({test::make_part(ShapeKind::kCapsule, {0.02, 0.025, 0.02},
                                                         {glm::dvec3(0.0, 0.02, 0.0), lying})}));
  Hand hand(scene);
  hand.step_to({{glm::dvec3(0.0, 1e-4, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move(glm::dvec3(0.0, -1e-4 - kDeep, 0.0), kUp, 0.0, 200);
  const double sixth = 0.1047;  // rad, 6 degrees
  hand.move(glm::dvec3(0.0), kUp, sixth, 100);
  const double first = hand.wrench().torque.y;
  hand.move(glm::dvec3(0.0), kUp, 9.0 * sixth, 900);
  EXPECT_LT(first, 0.0);
  EXPECT_NEAR(hand.wrench().torque.y, 10.0 * first, 0.02 * std::abs(10.0 * first));
}

}  // namespace
}  // namespace torsion::engine
