#include <numbers>

#include <gtest/gtest.h>

#include "systems/paper/paper.hpp"
#include "tests/reference/paper_shaft.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using reference::PaperShaft;
using test::Hand;
using test::kUp;

constexpr double kPressDepth = 4e-4;  // m

/// The ball of the paper pressed into the cube's top, not turned yet.
Hand pressed_ball(std::uint32_t grid_side = 16, const Friction& friction = {},
                  double start_depth = 0.0) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].friction = friction;
  PrepareOptions options;
  options.settings.grid_side = grid_side;
  Hand hand(scene, options);
  hand.step_to({{glm::dvec3(0.0, 0.15 + 1e-4, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move(glm::dvec3(0.0, -1e-4 - kPressDepth - start_depth, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0,
            200);
  return hand;
}

/// The closed form with the region's own force, radius and lever.
PaperShaft shaft_of(const Hand& hand) {
  const World& world = hand.world();
  return {world.state.regions.at<RegionNormal>(0).force,
          world.model.bodies.at<Friction>(0).dynamic_friction,
          world.model.bodies.at<Elasticity>(0).shear_modulus(),
          world.state.regions.at<Contact>(0).radius, world.state.regions.at<RegionMotion>(0).lever};
}

TEST(PaperTorqueTest, RegionOfThePressedBallIsTheOverlapDisc) {
  const Hand hand = pressed_ball();
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  const Contact& contact = hand.world().state.regions.at<Contact>(0);
  // The sphere cuts the plane in a disc of a^2 = 2 R d - d^2; the grid's cells, 0.14 a wide,
  // resolve its area to about half of their square over a^2.
  const double exact = std::sqrt(2.0 * 0.05 * kPressDepth - kPressDepth * kPressDepth);
  EXPECT_NEAR(contact.radius, exact, 0.005 * exact);
  // Volume of the spherical cap, pi d^2 (3 R - d) / 3, over the disc's area.
  const double mean_depth =
      kPressDepth * kPressDepth * (3.0 * 0.05 - kPressDepth) / (3.0 * exact * exact);
  EXPECT_NEAR(contact.depth, mean_depth, 0.005 * mean_depth);
  EXPECT_NEAR(hand.world().state.regions.at<Overlap>(0).largest_depth, kPressDepth,
              0.01 * kPressDepth);
}

TEST(PaperTorqueTest, CellsInContactAreAboutTwoHundred) {
  const Hand hand = pressed_ball();
  int covered = 0;
  for (const CellGeometry& cell : hand.world().state.cells.rows<CellGeometry>(
           hand.world().state.regions.at<RegionIdentity>(0).cells)) {
    covered += cell.coverage > 0.0 ? 1 : 0;
  }
  EXPECT_GE(covered, 150);
  EXPECT_LE(covered, 220);
}

TEST(PaperTorqueTest, NoTorqueWithoutMotion) {
  const Hand hand = pressed_ball();
  // A symmetric press: rounding aside there is nothing to turn about.
  EXPECT_LT(glm::length(hand.wrench().torque), 1e-9 * shaft_of(hand).full_slip_torque() + 1e-9);
  EXPECT_GT(hand.wrench().force.y, 1.0);
}

TEST(PaperTorqueTest, LoadingFollowsTheClosedIntegralWithinTwoPercent) {
  Hand hand = pressed_ball();
  const PaperShaft shaft = shaft_of(hand);
  const double yield = shaft.yield_turn();
  double turn = 0.0;
  for (const double share : {0.1, 0.5, 0.9, 1.0, 1.2, 1.5, 2.0, 3.0, 6.0}) {
    hand.move(glm::dvec3(0.0), kUp, share * yield - turn, 100);
    turn = share * yield;
    // The contact opposes the turn.
    EXPECT_NEAR(-hand.wrench().torque.y, shaft.torque(turn), 0.02 * shaft.torque(turn))
        << "at turn " << turn;
  }
}

TEST(PaperTorqueTest, ElasticBranchIsThatOfAShaft) {
  Hand hand = pressed_ball();
  const PaperShaft shaft = shaft_of(hand);
  hand.move(glm::dvec3(0.0), kUp, 0.3 * shaft.yield_turn(), 50);
  const double exact = shaft.shear_modulus * std::numbers::pi * std::pow(shaft.radius, 4) * 0.3 *
                       shaft.yield_turn() / (2.0 * shaft.lever);
  EXPECT_NEAR(-hand.wrench().torque.y, exact, 0.02 * exact);
}

TEST(PaperTorqueTest, FullSlipIsTwoThirdsMuForceRadius) {
  Hand hand = pressed_ball();
  const PaperShaft shaft = shaft_of(hand);
  hand.move(glm::dvec3(0.0), kUp, 40.0 * shaft.yield_turn(), 2000);
  // The remaining elastic core is (1/40)^3 / 4 of the whole.
  EXPECT_NEAR(-hand.wrench().torque.y, shaft.full_slip_torque(), 0.02 * shaft.full_slip_torque());
}

TEST(PaperTorqueTest, ErrorFallsWithTheNumberOfCells) {
  const auto worst_error = [](std::uint32_t side) {
    Hand hand = pressed_ball(side);
    const PaperShaft exact_disc = [&] {
      PaperShaft shaft = shaft_of(hand);
      shaft.radius = std::sqrt(2.0 * 0.05 * kPressDepth - kPressDepth * kPressDepth);
      return shaft;
    }();
    const double yield = exact_disc.yield_turn();
    double worst = 0.0;
    double turn = 0.0;
    for (const double share : {0.5, 1.0, 1.5, 3.0}) {
      hand.move(glm::dvec3(0.0), kUp, share * yield - turn, 50);
      turn = share * yield;
      worst = std::max(worst, std::abs(-hand.wrench().torque.y / exact_disc.torque(turn) - 1.0));
    }
    return worst;
  };
  const double coarse = worst_error(8);
  const double fine = worst_error(32);
  // The area of cells with a covered share errs by less than their size squared, and the torque
  // goes with a^4 at most: second order would give a factor of 16 from 8 to 32, first order 4.
  EXPECT_LT(fine, coarse / 8.0);
  EXPECT_LT(fine, 8.0 / (32.0 * 32.0));
}

TEST(PaperTorqueTest, ReversingUnloadsElastically) {
  Hand hand = pressed_ball();
  const PaperShaft shaft = shaft_of(hand);
  const double far = 3.0 * shaft.yield_turn();
  hand.move(glm::dvec3(0.0), kUp, far, 300);
  const double top = hand.wrench().torque.y;
  const double back = 0.2 * shaft.yield_turn();
  hand.move(glm::dvec3(0.0), kUp, -back, 50);
  // Every cell is within its limit again, so the whole disc unloads with the initial stiffness.
  const double stiffness = shaft.torque(0.1 * shaft.yield_turn()) / (0.1 * shaft.yield_turn());
  EXPECT_NEAR(hand.wrench().torque.y - top, stiffness * back, 0.02 * stiffness * back);
  // Masing: the unloading curve is the loading curve, doubled.
  hand.move(glm::dvec3(0.0), kUp, -2.0 * far + back, 600);
  EXPECT_NEAR(hand.wrench().torque.y, -top, 0.02 * std::abs(top));
}

TEST(PaperTorqueTest, TorqueIsOddInTheTurn) {
  for (const double share : {0.5, 2.0}) {
    Hand left = pressed_ball();
    Hand right = pressed_ball();
    const double turn = share * shaft_of(left).yield_turn();
    left.move(glm::dvec3(0.0), kUp, turn, 100);
    right.move(glm::dvec3(0.0), kUp, -turn, 100);
    // Mirror images up to rounding; the grid is mirror symmetric too.
    EXPECT_NEAR(left.wrench().torque.y, -right.wrench().torque.y,
                1e-6 * std::abs(left.wrench().torque.y));
  }
}

TEST(PaperTorqueTest, CurveDoesNotDependOnTheStepSize) {
  Hand coarse = pressed_ball();
  Hand fine = pressed_ball();
  const double turn = 2.0 * shaft_of(coarse).yield_turn();
  coarse.move(glm::dvec3(0.0), kUp, turn, 100);
  fine.move(glm::dvec3(0.0), kUp, turn, 5000);
  // The return map of a proportional path is exact for any step.
  EXPECT_NEAR(coarse.wrench().torque.y, fine.wrench().torque.y,
              1e-3 * std::abs(fine.wrench().torque.y));
}

TEST(PaperTorqueTest, StaticFrictionComesDownToDynamicWithoutAJump) {
  const Friction friction{0.9, 0.75};
  Hand hand = pressed_ball(16, friction);
  PaperShaft shaft = shaft_of(hand);
  const double far = 8.0 * shaft.yield_turn();
  double largest_jump = 0.0;
  double before = hand.wrench().torque.y;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    hand.move(glm::dvec3(0.0), kUp, far / kSteps, 1);
    largest_jump = std::max(largest_jump, std::abs(hand.wrench().torque.y - before));
    before = hand.wrench().torque.y;
  }
  // Nearly everything slips in the end with mu_d: (8/1.2)^-3 / 4 of the torque is the core.
  EXPECT_NEAR(-hand.wrench().torque.y, shaft.full_slip_torque(), 0.02 * shaft.full_slip_torque());
  // One cell's share of the torque is about 1/200, its drop 1/6 of that; a step takes 1/500 of the
  // yield turn.
  EXPECT_LT(largest_jump, 0.01 * shaft.full_slip_torque());
}

TEST(PaperTorqueTest, SlidingBallFeelsMuTimesForceAndNoCouple) {
  Hand hand = pressed_ball();
  const double force = hand.wrench().force.y;
  hand.move(glm::dvec3(0.004, 0.0, 0.0), kUp, 0.0, 400);
  EXPECT_NEAR(-hand.wrench().force.x, 0.75 * force, 0.01 * force);
  EXPECT_NEAR(hand.wrench().force.z, 0.0, 1e-6 * force);
  // T = r x F about the ball's centre: the contact is about R below it. A scripted pose does not
  // turn with it.
  EXPECT_NEAR(hand.wrench().torque.z, -0.75 * force * 0.0498, 0.02 * 0.75 * force * 0.05);
  EXPECT_NEAR(hand.wrench().torque.y, 0.0, 1e-4 * shaft_of(hand).full_slip_torque());
}

TEST(PaperTorqueTest, SlidingWhileSpinningStaysInsideTheLimitSurface) {
  Hand hand = pressed_ball();
  const PaperShaft shaft = shaft_of(hand);
  // Long enough that everything slips, with rim speed about equal to the sliding speed.
  for (int i = 0; i < 3000; ++i) {
    hand.move(glm::dvec3(2e-6, 0.0, 0.0), kUp, 2e-6 / shaft.radius, 1);
    const double force =
        std::hypot(hand.wrench().force.x, hand.wrench().force.z) / (0.75 * hand.wrench().force.y);
    const double torque = hand.wrench().torque.y / shaft.full_slip_torque();
    // The limit surface of a disc under uniform pressure lies inside the unit circle in these axes
    // (physics B7).
    EXPECT_LE(force * force + torque * torque, 1.0 + 0.02) << "step " << i;
  }
  const double force =
      std::hypot(hand.wrench().force.x, hand.wrench().force.z) / (0.75 * hand.wrench().force.y);
  EXPECT_GT(force, 0.5);
}

}  // namespace
}  // namespace torsion::engine
