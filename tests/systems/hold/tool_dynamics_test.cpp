#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/hold/tool_hold.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kUnlimited;
using test::kUpright;

constexpr double kFree = 0.2;  // m: a height at which the ball touches nothing

PrepareOptions half_space(double rate = 1000.0) {
  PrepareOptions options;
  options.rate = rate;
  options.contact_model = ContactModel::kMdr;
  options.body_model = BodyModel::kNone;
  return options;
}

VirtualCoupling springs(double stiffness, double turn_stiffness) {
  return {stiffness, 0.0, turn_stiffness, 0.0, kUnlimited, kUnlimited};
}

/// Farthest that the tool is in 0.2 s from X (1 - exp(-z w t) (cos w' t + z w / w' sin w' t)),
/// w' = w sqrt(1 - z^2), the answer of a damped oscillator to a handle that is suddenly X = 1 mm
/// off, as a share of X.
double error_of_free_motion(double rate, double stiffness) {
  constexpr double kOff = 1e-3;  // m
  test::Hand hand(test::ball_on_cube(), half_space(rate));
  const Pose start{{0.0, kFree, 0.0}, kUpright};
  hand.step_to({start});
  hand.step_to({start});
  const VirtualCoupling coupling = springs(stiffness, 1.0);
  const Pose handle{{kOff, kFree, 0.0}, kUpright};
  const MassProperties& properties = hand.world().model.tools.at<MassProperties>(0);
  const double frequency = std::sqrt(stiffness / properties.mass);
  const double decay = 0.5 * choose_damping(coupling, properties).translation / properties.mass;
  const double ringing = std::sqrt(frequency * frequency - decay * decay);
  double worst = 0.0;
  for (int i = 1; i <= static_cast<int>(0.2 * rate); ++i) {
    hand.step_to(
        {next_heavy_tool_pose(hand.world().model, hand.world().state, 0, coupling, handle)});
    const double t = i / rate;
    const double exact =
        kOff * (1.0 - std::exp(-decay * t) *
                          (std::cos(ringing * t) + decay / ringing * std::sin(ringing * t)));
    const double x = hand.world().state.tools.at<ToolPose>(0).now.position.x;
    worst = std::max(worst, std::abs(x - exact) / kOff);
  }
  return worst;
}

TEST(ToolDynamicsTest, MovesAsADampedMassOnASpring) {
  // Backward Euler is of first order: it damps by w h / 2 more, which after the time t makes an
  // error of w^2 h t / 2 exp(-z w t), at most w h / (2 z e); half as large with half the step.
  constexpr double kStiffness = 900.0;  // N/m; the mass is 1 kg: w = 30 / s
  const double coarse = error_of_free_motion(1000.0, kStiffness);
  const double fine = error_of_free_motion(2000.0, kStiffness);
  EXPECT_LT(coarse, 30.0 * 1e-3 / (2.0 * 0.1 * 2.718));
  EXPECT_GT(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 2.0, 0.1);
}

TEST(ToolDynamicsTest, NothingThatPullsLetsItMoveOn) {
  test::Hand hand(test::ball_on_cube(), half_space());
  const glm::dvec3 each{1e-4, 2e-4, -5e-5};  // m a step
  for (int i = 0; i < 3; ++i) {
    hand.step_to({{glm::dvec3(0.0, kFree, 0.0) + static_cast<double>(i) * each, kUpright}});
  }
  for (int i = 3; i < 50; ++i) {
    hand.step_to({next_heavy_tool_pose(hand.world().model, hand.world().state, 0, {}, {})});
    const glm::dvec3 there = glm::dvec3(0.0, kFree, 0.0) + static_cast<double>(i) * each;
    EXPECT_LT(glm::distance(hand.world().state.tools.at<ToolPose>(0).now.position, there), 1e-12);
  }
}

TEST(ToolDynamicsTest, ComesToRestWhereAToolWithoutMassDoes) {
  for (const double stiffness : {200.0, 5000.0, 1e6}) {
    test::Hand heavy(test::ball_on_cube(), half_space());
    test::Hand light(test::ball_on_cube(), half_space());
    const Pose start{{0.0, 0.1501, 0.0}, kUpright};
    heavy.step_to({start});
    light.step_to({start});
    const VirtualCoupling coupling = springs(stiffness, 2.0);
    // So deep that the contact pushes with about 1 N in all three.
    const double down = 1.0 / stiffness + 1e-3;
    for (int i = 0; i < 6000; ++i) {
      const double share = std::min(1.0, i / 500.0);
      const Pose handle{{0.0, 0.1501 - down * share, 0.0},
                        glm::angleAxis(0.05 * share, glm::dvec3(0.0, 1.0, 0.0))};
      heavy.step_to(
          {next_heavy_tool_pose(heavy.world().model, heavy.world().state, 0, coupling, handle)});
      light.step_to(
          {next_tool_pose(light.world().model, light.world().state, 0, coupling, handle)});
    }
    SCOPED_TRACE(testing::Message() << stiffness << " N/m");
    EXPECT_GT(light.wrench().force.y, 0.5);
    EXPECT_NEAR(heavy.wrench().force.y, light.wrench().force.y, 1e-3 * light.wrench().force.y);
    EXPECT_EQ(heavy.clock().faults, 0U);
    const glm::dvec3 velocity = heavy.world().state.tools.at<ToolMotion>(0).velocity;
    EXPECT_LT(glm::length(velocity), 1e-6);
  }
}

}  // namespace
}  // namespace torsion::engine
