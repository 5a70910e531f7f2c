// What sticks of a contact: the ring that a window draws, and the share that a trace has.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::PressedBall;

class StickShareTest : public testing::TestWithParam<ContactModel> {
 public:
  static BallScene scene() {
    BallScene scene;
    scene.model = GetParam();
    return scene;
  }
};

/// Of the area.
double stick_share(const PressedBall& ball) {
  return ball.hand.world().state.regions.at<RegionFriction>(0).stick_share;
}

/// Of the cells with pressure, as the trace has it.
double stick_fraction(const PressedBall& ball) {
  const World& world = ball.hand.world();
  double stuck = 0.0;
  for (const CellTraction& cell :
       world.state.cells.rows<CellTraction>(world.state.regions.at<RegionIdentity>(0).cells)) {
    stuck += cell.pressure > 0.0 && cell.sticks != 0 ? 1.0 : 0.0;
  }
  return stuck / ball.loaded_cells();
}

// Lubkin's stick radius, loading from rest.
TEST_P(StickShareTest, IsTheSquareOfLubkinsRadiusWhileATwistGrows) {
  PressedBall ball(scene());
  ball.press(test::kBallDepth, 60);
  double turn = 0.0;
  for (int part = 0; part < 8; ++part) {
    ball.twist(0.01, 40);
    turn += 0.01;
    const double share = reference::stick_radius(ball.lubkin(), turn) / ball.lubkin().radius;
    EXPECT_NEAR(stick_share(ball), share * share, 0.1) << turn;
    EXPECT_NEAR(stick_fraction(ball), share * share, 0.1) << turn;
  }
}

// Cattaneo's, (1 - Q / (mu F))^(1/3).
TEST_P(StickShareTest, IsTheSquareOfCattaneosRadiusWhileASlideGrows) {
  PressedBall ball(scene());
  ball.press(test::kBallDepth, 60);
  for (int part = 0; part < 8; ++part) {
    ball.slide({5e-5, 0.0}, 40);
    const double load = glm::length(ball.friction()) / (test::kBallFriction * ball.normal_force());
    const double share = std::cbrt(std::max(1.0 - load, 0.0));
    EXPECT_NEAR(stick_share(ball), share * share, 0.1) << load;
  }
}

// What counts is what slips in the step: all of it while it slides on, nothing while it is held.
TEST_P(StickShareTest, IsNothingInFullSlipAndAllWhileNothingMoves) {
  PressedBall ball(scene());
  ball.press(test::kBallDepth, 60);
  ball.slide({2e-3, 0.0}, 200);
  EXPECT_EQ(stick_share(ball), 0.0);
  EXPECT_EQ(stick_fraction(ball), 0.0);
  ball.slide({0.0, 0.0}, 20);
  EXPECT_GT(stick_share(ball), 0.95);
  EXPECT_GT(stick_fraction(ball), 0.95);
}

INSTANTIATE_TEST_SUITE_P(Models, StickShareTest,
                         testing::Values(ContactModel::kMdr, ContactModel::kPatch));

}  // namespace
}  // namespace torsion::engine
