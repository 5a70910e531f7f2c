#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reference/exact/flat_punch.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::PressedBall;

// A ball on half-spaces of every Poisson's ratio. Its shear modulus stays, so that torques do.

constexpr double kRatios[] = {0.0, 0.3, 0.4999, 0.5};

class PoissonTest : public testing::TestWithParam<std::tuple<ContactModel, double>> {
 protected:
  [[nodiscard]] static BallScene scene() {
    return {.model = std::get<0>(GetParam()), .poisson = std::get<1>(GetParam())};
  }
  [[nodiscard]] static bool is_patch() { return std::get<0>(GetParam()) == ContactModel::kPatch; }
};

TEST_P(PoissonTest, NormalForceLiesBetweenTheFrictionlessAndTheBonded) {
  // Friction holds back what pressure pulls inwards, which stiffens the contact, but no more than a
  // bonded one (physics: no coupling at nu = 0.5, where the ratio is 1). mdr leaves the coupling
  // out. 0.5 %: the cells.
  PressedBall ball(scene());
  ball.press(kBallDepth, 300);
  ball.press(kBallDepth, 20);
  const double share = ball.normal_force() / ball.hertz().force;
  EXPECT_GE(share, 1.0 - 0.005);
  EXPECT_LE(share,
            (is_patch() ? reference::bonded_punch_ratio(std::get<1>(GetParam())) : 1.0) + 0.005);
}

TEST_P(PoissonTest, TheTwistEndsAtTheLargestCoupleAndTheSlideAtFriction) {
  // (3 pi / 16) mu F a once everything slips around, whatever the ratio: no friction is left for
  // the radial direction, and the pressure is Hertz's again. Likewise mu F once everything slips
  // along, but for what the coupling turns of it: nothing of the sum.
  PressedBall turned(scene());
  turned.press(kBallDepth, 300);
  turned.twist(1.0, 300);
  EXPECT_NEAR(-turned.couple() / reference::saturated_torque(turned.lubkin()), 1.0, 0.01);
  PressedBall slid(scene());
  slid.press(kBallDepth, 300);
  slid.slide({3.0 * reference::full_slip_displacement(slid.mindlin()), 0.0}, 300);
  EXPECT_NEAR(-slid.friction().x / (test::kBallFriction * slid.normal_force()), 1.0, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Ratios, PoissonTest,
                         testing::Combine(testing::Values(ContactModel::kMdr, ContactModel::kPatch),
                                          testing::ValuesIn(kRatios)));

/// Friction over its limit and couple over its largest along a twist and a slide.
void follow(PressedBall& ball, double* loads) {
  const double slide = reference::full_slip_displacement(ball.mindlin());
  const double limit = reference::full_slip_force(ball.mindlin());
  const double largest = reference::saturated_torque(ball.lubkin());
  const double turn = largest / reference::torsional_stiffness(ball.lubkin());
  for (int step = 0; step < 200; ++step) {
    ball.go(kBallDepth, {step < 100 ? 0.0 : 0.01 * slide, 0.0}, (step < 100 ? 0.01 : -0.01) * turn,
            1);
    *loads++ = ball.friction().x / limit;
    *loads++ = ball.couple() / largest;
  }
}

TEST(NearlyIncompressibleTest, MovesAsTheIncompressible) {
  // The coupling goes with (1 - 2 nu) / (2 (1 - nu)) = 2e-4: no load can differ by more than some
  // of these from those without it. Where the twist turns back and the slide begins, one iteration
  // more or less in a step of patch makes that up to 1.5e-3, on the grids that 12 speeds lead to.
  for (const auto& [model, steps, bound] :
       {std::tuple{ContactModel::kMdr, 300, 1e-3}, std::tuple{ContactModel::kPatch, 250, 2e-3},
        std::tuple{ContactModel::kPatch, 300, 2e-3}, std::tuple{ContactModel::kPatch, 320, 2e-3}}) {
    std::vector<double> nearly(400);
    std::vector<double> quite(400);
    for (const auto& [poisson, loads] : {std::pair{0.4999, &nearly}, std::pair{0.5, &quite}}) {
      PressedBall ball({.model = model, .poisson = poisson});
      ball.press(kBallDepth, steps);
      follow(ball, loads->data());
    }
    for (std::size_t k = 0; k < quite.size(); ++k) {
      EXPECT_NEAR(nearly[k], quite[k], bound) << steps << " " << k;
    }
  }
}

}  // namespace
}  // namespace torsion::engine
