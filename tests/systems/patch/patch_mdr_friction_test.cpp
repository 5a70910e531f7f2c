#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::PressedBall;

constexpr double kStatic = 0.9;
constexpr double kDynamic = 0.6;

struct FrictionCase {
  const char* name;
  BallScene scene;
  double peak;  // at least, over the normal force
};

void PrintTo(const FrictionCase& model, std::ostream* out) {
  *out << model.name;
}

// While the rim slips already at mu_d the middle still sticks, so no contact of a ball shows all of
// mu_s at once. patch goes over cell by cell; mdr has one state for all of a region, which most of
// the way is down before the last spring slips.
const FrictionCase kFrictionCases[] = {
    {"mdr", {.model = ContactModel::kMdr}, 1.005 * kDynamic},
    {"patch12", {.side = 12}, 1.04 * kDynamic},
    {"patch16", {.side = 16}, 1.04 * kDynamic},
};

class FrictionTest : public testing::TestWithParam<FrictionCase> {
 protected:
  [[nodiscard]] static BallScene scene() {
    BallScene ball = GetParam().scene;
    ball.static_friction = kStatic;
    ball.dynamic_friction = kDynamic;
    return ball;
  }
};

/// Friction over the normal force along x at every step of a slide.
std::vector<double> slide(PressedBall& ball, double way, int steps) {
  std::vector<double> forces;
  for (int step = 0; step < steps; ++step) {
    ball.slide({way / steps, 0.0}, 1);
    forces.push_back(-ball.friction().x / ball.normal_force());
  }
  return forces;
}

/// Largest swing, up and down again or the other way round, after `first`.
double largest_swing(const std::vector<double>& forces, std::size_t first) {
  double swing = 0.0;
  double turning_point = forces[first];
  for (std::size_t i = first + 1; i + 1 < forces.size(); ++i) {
    if ((forces[i] - forces[i - 1]) * (forces[i + 1] - forces[i]) < 0.0) {
      swing = std::max(swing, std::abs(forces[i] - turning_point));
      turning_point = forces[i];
    }
  }
  return swing;
}

TEST_P(FrictionTest, ASlideHasAStaticPeakAndADynamicPlateauWithoutChatter) {
  // 4 mm, seven times the slide at which everything slips: mu E* / Gt depth = 0.56 mm at mu_s.
  for (const int steps : {400, 4000}) {
    PressedBall ball(scene());
    ball.press(kBallDepth, 300);
    const std::vector<double> forces = slide(ball, 4e-3, steps);
    const double peak = *std::max_element(forces.begin(), forces.end());
    EXPECT_GE(peak, GetParam().peak) << steps;
    EXPECT_LE(peak, kStatic) << steps;
    // Once down, it stays at mu_d and does not swing: 0.1 % of the normal force is what the cells'
    // rim does as it wanders with the ball.
    const std::size_t half = forces.size() / 2;
    for (std::size_t i = half; i < forces.size(); ++i) {
      EXPECT_NEAR(forces[i], kDynamic, 0.005 * kDynamic) << i;
    }
    EXPECT_LE(largest_swing(forces, half), 1e-3) << steps;
  }
}

TEST_P(FrictionTest, EqualCoefficientsHaveNoPeak) {
  BallScene same = GetParam().scene;
  same.static_friction = kDynamic;
  same.dynamic_friction = kDynamic;
  PressedBall ball(same);
  ball.press(kBallDepth, 300);
  const std::vector<double> forces = slide(ball, 2e-3, 400);
  for (std::size_t i = 1; i < forces.size(); ++i) {
    // The sum over cells at their limits is the limit; rounding, and the residual of 1e-3 of a
    // grid that has just moved.
    EXPECT_LE(forces[i], kDynamic * (1.0 + 1e-3));
  }
}

TEST_P(FrictionTest, ATwistEndsAtTheDynamicCouple) {
  PressedBall ball(scene());
  ball.press(kBallDepth, 300);
  std::vector<double> couples;
  const double largest = reference::saturated_torque(ball.lubkin());  // with mu_d
  for (int step = 0; step < 1000; ++step) {
    ball.twist(1e-3, 1);
    couples.push_back(-ball.couple() / largest);
  }
  const double peak = *std::max_element(couples.begin(), couples.end());
  EXPECT_LE(peak, kStatic / kDynamic);
  // Spinning saturates only little by little: 1 - exp(-9 pi^2 / 64 times the natural turns, 30
  // here), after which the error is that of the cells.
  EXPECT_NEAR(couples.back(), 1.0, 0.008);
  EXPECT_LE(largest_swing(couples, 500), 2e-3);
}

TEST_P(FrictionTest, TheWayBackBringsStaticFrictionBack) {
  PressedBall ball(scene());
  ball.press(kBallDepth, 300);
  slide(ball, 4e-3, 800);
  // Turning round, everything sticks over twice the elastic way: mu_s is back when it slips again.
  const std::vector<double> back = slide(ball, -4e-3, 800);
  const double peak = -*std::min_element(back.begin(), back.end());
  EXPECT_GE(peak, 1.003 * kDynamic);
  EXPECT_LE(peak, kStatic);
  EXPECT_NEAR(back.back(), -kDynamic, 0.005 * kDynamic);
}

INSTANTIATE_TEST_SUITE_P(Models, FrictionTest, testing::ValuesIn(kFrictionCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace torsion::engine
