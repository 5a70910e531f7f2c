// What stands between a device and the physics, with every fault that it guards against.

#include "systems/hold/handle_side.hpp"

#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/math/frames.hpp"
#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kPeriod;

/// A device at a kilohertz, and a physics thread that holds the tool where the test says.
struct Rig {
  HandleSide side;
  DeviceSample sample;
  PhysicsResult result;
  double now = 10.0;
  bool physics_runs = true;

  /// Its signs are taken to be right, and its force rises the first time as any other: those are
  /// tested by themselves.
  Rig() {
    side.safety.checks_signs = false;
    side.limits.first_rise = side.limits.rise;
    sample.state = DeviceState::kLive;
    sample.epoch = 1;
    sample.sensed = kTranslationAxes | kRotationAxes;
    sample.traits.damping = 1.0;
    sample.traits.mass = 0.2;
    sample.traits.largest_force = 8.0;
    sample.traits.largest_torque = 0.2;
    result.any = true;
  }
  HandleOutcome step() {
    now += kPeriod;
    result.time = physics_runs ? now - 0.5 * kPeriod : result.time;
    return take_handle_sample(side, sample, result, now);
  }
  HandleOutcome run(double seconds) {
    HandleOutcome last;
    for (int i = 0; i < static_cast<int>(seconds / kPeriod + 0.5); ++i) {
      last = step();
    }
    return last;
  }
  /// Takes hold of the tool and pushes it 3 mm down against what holds it.
  HandleOutcome press() {
    run(0.2);
    for (int i = 0; i < 100; ++i) {
      sample.pose.position.y = -3e-5 * i;
      step();
    }
    return run(0.1);
  }
};

TEST(HandleSideTest, PushesBackAgainstAToolThatIsHeld) {
  Rig rig;
  const HandleOutcome outcome = rig.press();
  EXPECT_TRUE(outcome.holds);
  // 0.9 b / (T / 2) = 1800 N/m over 2.97 mm, less the smooth limit at 8 N.
  const double pull = 1800.0 * 2.97e-3;
  EXPECT_NEAR(outcome.wrench.force.y, pull / std::sqrt(1.0 + pull * pull / 64.0), 1e-6);
}

TEST(HandleSideTest, BeginsWithoutForceAndWaitsForTheHandle) {
  Rig rig;
  rig.sample.pose.position = {0.05, 0.0, 0.0};
  HandleOutcome outcome = rig.run(1.0);
  EXPECT_FALSE(outcome.holds);
  EXPECT_EQ(outcome.wrench.force, glm::dvec3(0.0));
  EXPECT_NEAR(outcome.distance, 0.05, 1e-12);
  rig.sample.pose.position = {0.005, 0.0, 0.0};
  const double rate = 8.0 / 0.01;  // N/s
  glm::dvec3 before(0.0);
  for (int i = 0; i < 200; ++i) {
    outcome = rig.step();
    EXPECT_LE(glm::length(outcome.wrench.force - before), rate * kPeriod + 1e-12);
    before = outcome.wrench.force;
  }
  EXPECT_TRUE(outcome.holds);
  EXPECT_LT(outcome.wrench.force.x, -1.0);
}

TEST(HandleSideTest, ASteeredDeviceIsPutWhereTheToolIs) {
  Rig rig;
  rig.sample.steers_rate = true;
  rig.sample.pose.position = {3.0, -7.0, 0.4};  // wherever it was steered to before
  rig.result.tool.position = {0.0, 0.2, 0.0};
  const HandleOutcome outcome = rig.run(0.1);
  EXPECT_TRUE(outcome.holds);
  EXPECT_NEAR(glm::length(outcome.handle.position - rig.result.tool.position), 0.0, 1e-12);
}

TEST(HandleSideTest, WhatOnlyTurnsIsPutWhereTheToolIs) {
  Rig rig;
  rig.sample.sensed = kTurnAxis;
  rig.result.tool.position = {0.1, 0.2, 0.0};
  const HandleOutcome outcome = rig.run(0.1);
  EXPECT_TRUE(outcome.holds);
  EXPECT_NEAR(glm::length(outcome.handle.position - rig.result.tool.position), 0.0, 1e-12);
}

TEST(HandleSideTest, TakesHoldOfTheToolHoweverTheHandleIsTurned) {
  Rig rig;
  rig.sample.pose.rotation = glm::angleAxis(1.2, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
  rig.result.tool.rotation = glm::angleAxis(-0.4, glm::dvec3(0.0, 1.0, 0.0));
  rig.side.home.rotation = rig.result.tool.rotation;
  EXPECT_LT(glm::length(rig.run(0.2).wrench.torque), 1e-12);
  const glm::dquat turn = glm::angleAxis(0.1, glm::dvec3(0.0, 0.0, 1.0));
  rig.sample.pose.rotation = turn * rig.sample.pose.rotation;
  const HandleOutcome turned = rig.step();
  EXPECT_NEAR(glm::length(turn_between(rig.result.tool.rotation, turned.handle.rotation) -
                          glm::dvec3(0.0, 0.0, 0.1)),
              0.0, 1e-12);
}

TEST(HandleSideTest, FallsWhenThePhysicsIsSilentAndGoesOnWhenItIsBack) {
  Rig rig;
  const double before = glm::length(rig.press().wrench.force);
  rig.physics_runs = false;
  EXPECT_NEAR(glm::length(rig.run(2e-3).wrench.force), before, 1e-9);  // that late it may be
  EXPECT_EQ(rig.run(3e-3 + 10e-3).wrench.force, glm::dvec3(0.0));
  EXPECT_FALSE(rig.run(1.0).holds);
  rig.physics_runs = true;
  EXPECT_NEAR(glm::length(rig.run(0.5).wrench.force), before, 1e-6);
}

TEST(HandleSideTest, FallsOnAFaultOfThePhysics) {
  Rig rig;
  rig.press();
  rig.result.faulty = true;
  EXPECT_EQ(rig.run(11e-3).wrench.force, glm::dvec3(0.0));
}

TEST(HandleSideTest, NothingThatIsNotANumberIsSent) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const bool device : {true, false}) {
    Rig rig;
    rig.press();
    (device ? rig.sample.pose.position.x : rig.result.tool.position.x) = kNan;
    for (int i = 0; i < 20; ++i) {
      const Wrench sent = rig.step().wrench;
      ASSERT_TRUE(std::isfinite(glm::length(sent.force) + glm::length(sent.torque)));
    }
    EXPECT_EQ(rig.step().wrench.force, glm::dvec3(0.0));
    (device ? rig.sample.pose.position.x : rig.result.tool.position.x) = 0.0;
    EXPECT_GT(glm::length(rig.run(0.5).wrench.force), 1.0);  // and it recovers
  }
}

TEST(HandleSideTest, ADeviceThatComesBackBeginsAnew) {
  Rig rig;
  rig.press();
  rig.sample.state = DeviceState::kAbsent;
  EXPECT_EQ(rig.run(11e-3).wrench.force, glm::dvec3(0.0));
  rig.sample.state = DeviceState::kLive;
  rig.sample.epoch = 2;
  rig.sample.traits.largest_force = 2.0;  // another one
  rig.sample.pose.position = {0.0, 0.04, 0.0};
  EXPECT_FALSE(rig.run(0.1).holds);
  rig.sample.pose.position = {0.0, 0.005, 0.0};
  const HandleOutcome outcome = rig.run(0.3);
  EXPECT_TRUE(outcome.holds);
  EXPECT_LT(outcome.wrench.force.y, -1.0);
  EXPECT_GT(outcome.wrench.force.y, -2.0);
}

TEST(HandleSideTest, NeverMoreThanTheDeviceTakes) {
  Rig rig;
  rig.run(0.2);
  rig.sample.pose = {{0.0, -0.5, 0.0}, glm::angleAxis(2.0, glm::dvec3(0.0, 1.0, 0.0))};
  for (int i = 0; i < 100; ++i) {
    const Wrench sent = rig.step().wrench;
    EXPECT_LE(glm::length(sent.force), 8.0);
    EXPECT_LE(glm::length(sent.torque), 0.2);
  }
}

}  // namespace
}  // namespace torsion::engine
