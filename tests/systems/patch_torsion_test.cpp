#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reference/exact/flat_punch.hpp"
#include "tests/reference/exact/masing.hpp"
#include "tests/systems/pressed_ball.hpp"

namespace torsion {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::PressedBall;

struct Resolution {
  std::uint32_t side;
  std::uint32_t sweeps;
  double loading;    // bounds of the torque's error over the largest torque
  double unloading;  // Masing's rule doubles what the first loading has
};

// Grids of 12 and 16 cells a side have 50 to 90 and 105 to 155 cells in contact. How well their
// staircase of a rim stands for the circle is luck: over many depths the torque is 0.5 to 1.6 % and
// 0.2 to 0.7 % off, and one in ten is off by twice the usual on the way back. Two sweeps a step
// (the default) lag behind by about 1 % when a turn begins at 50 steps a natural turn; forty do
// not.
constexpr Resolution kCoarse{12, 2, 0.02, 0.04};
constexpr Resolution kFine{16, 2, 0.012, 0.02};
constexpr Resolution kFinest{24, 40, 0.005, 0.0065};

/// Worst errors over the largest torque, of a twist to four natural turns and back to zero.
struct TorqueErrors {
  double loading = 0.0;
  double unloading = 0.0;
};

TorqueErrors twist_and_back(PressedBall& ball) {
  const reference::LubkinContact exact = ball.lubkin();
  const double largest = reference::saturated_torque(exact);
  const double top = 4.0 * largest / reference::torsional_stiffness(exact);
  constexpr int kSteps = 200;
  TorqueErrors worst;
  for (int step = 1; step <= kSteps; ++step) {
    ball.twist(top / kSteps, 1);
    const double expected = reference::torque(exact, top * step / kSteps);
    worst.loading = std::max(worst.loading, std::abs(-ball.couple() - expected) / largest);
  }
  for (int step = kSteps - 1; step >= -kSteps; --step) {
    ball.twist(-top / kSteps, 1);
    const double expected = reference::torque_after_turn(exact, top, top * step / kSteps);
    worst.unloading = std::max(worst.unloading, std::abs(-ball.couple() - expected) / largest);
  }
  return worst;
}

class PatchTorsionTest : public testing::TestWithParam<Resolution> {};

TEST_P(PatchTorsionTest, TwistAndUnloadingFollowLubkin) {
  const Resolution& resolution = GetParam();
  for (const double depth : {1.0, 1.3, 1.7}) {
    BallScene scene;
    scene.side = resolution.side;
    scene.sweeps = resolution.sweeps;
    PressedBall ball(scene);
    ball.press(depth * kBallDepth, 300);
    const TorqueErrors errors = twist_and_back(ball);
    EXPECT_LE(errors.loading, resolution.loading) << depth;
    EXPECT_LE(errors.unloading, resolution.unloading) << depth;
  }
}

TEST_P(PatchTorsionTest, NormalForceIsHertzsOnceSettled) {
  const Resolution& resolution = GetParam();
  BallScene scene;
  scene.side = resolution.side;
  scene.sweeps = resolution.sweeps;
  PressedBall ball(scene);
  for (int step = 1; step <= 10; ++step) {
    ball.press(kBallDepth * step / 10.0, 30);
    ball.press(ball.depth(), 20);
    // A sphere is up to 0.1 % stiffer than the paraboloid (Sneddon, at a / R = 0.09). The staircase
    // of the rim carries little: the force, unlike the torque, is stationary in the contact's
    // outline.
    const reference::SneddonSphere sphere = reference::sneddon_sphere_at_depth(
        test::kBallRadius, 4.0 * test::kBallShearModulus, ball.depth());
    EXPECT_NEAR(ball.normal_force() / sphere.force, 1.0, 0.005) << step;
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, PatchTorsionTest, testing::Values(kCoarse, kFine, kFinest));

TEST(PatchConvergenceTest, TorqueConvergesWithTheCells) {
  // Twelve sweeps lag no more than the cells miss. Means over three depths, for where the staircase
  // of the rim happens to lie is luck.
  std::vector<double> errors;
  for (const std::uint32_t side : {8U, 16U, 32U}) {
    double sum = 0.0;
    for (const double depth : {1.0, 1.3, 1.7}) {
      BallScene scene;
      scene.side = side;
      scene.sweeps = 12;
      PressedBall ball(scene);
      ball.press(depth * kBallDepth, 300);
      sum += twist_and_back(ball).unloading / 3.0;
    }
    errors.push_back(sum);
  }
  // Errors go with the rim's cells, at least as 1 / side. From the coarsest grid on: where the
  // staircase is lucky at one size, the next one need not halve it.
  EXPECT_LE(errors[1], 0.5 * errors[0]);
  EXPECT_LE(errors[2], 0.25 * errors[0]);
  EXPECT_LE(errors[2], errors[1]);
}

TEST(PatchCompressibleTest, NormalForceLiesBetweenTheFrictionlessAndTheBonded) {
  // With nu < 0.5 friction holds back what the pressure pulls inwards and stiffens the contact; no
  // more than a bonded one is stiffer. 0.5 %: the cells, as above.
  for (const double poisson : {0.0, 0.3, 0.45}) {
    BallScene scene;
    scene.poisson = poisson;
    PressedBall ball(scene);
    ball.press(kBallDepth, 300);
    ball.press(kBallDepth, 50);
    const double share = ball.normal_force() / ball.hertz().force;
    EXPECT_GE(share, 1.0 - 0.005) << poisson;
    EXPECT_LE(share, reference::bonded_punch_ratio(poisson) + 0.005) << poisson;
  }
}

TEST(PatchCompressibleTest, LargestTorqueIsThatOfTheForceThatThereIs) {
  // Once everything slips around, no friction is left for the radial direction: (3 pi / 16) mu F a,
  // with the force that there is; its pressure is Hertz' but for the coupling, which then vanishes.
  for (const double poisson : {0.0, 0.3, 0.45}) {
    BallScene scene;
    scene.poisson = poisson;
    PressedBall ball(scene);
    ball.press(kBallDepth, 300);
    ball.twist(1.0, 600);
    const double largest = reference::saturated_torque(ball.lubkin());
    EXPECT_NEAR(-ball.couple() / largest, 1.0, 0.01) << poisson;
    EXPECT_NEAR(ball.normal_force() / ball.hertz().force, 1.0, 0.01) << poisson;
  }
}

TEST(PatchHysteresisTest, LoopsInLoopsFollowMasing) {
  PressedBall ball(BallScene{});
  ball.press(kBallDepth, 300);
  const reference::LubkinContact exact = ball.lubkin();
  const double largest = reference::saturated_torque(exact);
  const double unit = largest / reference::torsional_stiffness(exact);
  const auto loading = [&](double twist) {
    return reference::torque(exact, twist);
  };
  reference::MasingHistory history;
  double at = 0.0;
  for (const double turn : {0.8, 0.2, 0.5, 0.35, 0.5, -0.3, -1.2, 0.0, -0.2, 0.4, -2.0, 2.0}) {
    const int steps = static_cast<int>(std::ceil(std::abs(turn - at / unit) / 0.02));
    const double change = (turn * unit - at) / steps;
    for (int step = 0; step < steps; ++step) {
      ball.twist(change, 1);
      at += change;
      // The error of unloading, and once more for the loop in the loop.
      EXPECT_NEAR(-ball.couple(), reference::move_to(history, loading, at), 0.03 * largest)
          << at / unit;
    }
  }
}

}  // namespace
}  // namespace torsion
