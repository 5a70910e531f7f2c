#include "systems/hold/count_play.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/math/frames.hpp"
#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kPeriod;

constexpr double kCount = 1e-4;      // m
constexpr double kTurnCount = 1e-2;  // rad
const glm::dquat kNoTurn(1.0, 0.0, 0.0, 0.0);

/// What encoders say of a handle at height y that is turned about y.
Pose said(double y, double angle) {
  return {{0.0, std::round(y / kCount) * kCount, 0.0},
          glm::angleAxis(std::round(angle / kTurnCount) * kTurnCount, glm::dvec3(0.0, 1.0, 0.0))};
}

TEST(CountPlayTest, AHandleThatTremblesAboutTheEdgeOfACountStandsStill) {
  Pose pose;
  for (std::size_t i = 0; i < 2000; ++i) {
    const int counts = std::array{0, 1, 1, -1, 0, 1}[i % 6];
    pose = follow_counts(pose, said(counts * kCount, counts * kTurnCount), kCount, kTurnCount,
                         kPeriod);
    EXPECT_EQ(pose.position.y, 0.0);
    EXPECT_EQ(turn_between(kNoTurn, pose.rotation).y, 0.0);
  }
}

TEST(CountPlayTest, IsForCoarseCountsBehindSoftSprings) {
  EXPECT_TRUE(needs_play(0.1 / 256.0, 200.0, 8.0));
  EXPECT_FALSE(needs_play(64e-6, 390.0, 8.0));   // a Falcon's: 0.3 %
  EXPECT_FALSE(needs_play(64e-6, 1000.0, 5.0));  // a WoodenHaptics', which play would let swing
  EXPECT_FALSE(needs_play(0.0, 200.0, 8.0));
  EXPECT_TRUE(needs_turn_play(0.025, 0.2, 0.2));
  EXPECT_FALSE(needs_turn_play(7.7e-4, 0.2, 0.2));
  EXPECT_FALSE(needs_turn_play(0.025, 0.5, 0.2));
}

TEST(CountPlayTest, GoesAtOnceToWithinTwoCountsAndSlowlyToWithinOne) {
  Pose pose;
  const Pose measured = said(10.0 * kCount, 10.0 * kTurnCount);
  pose = follow_counts(pose, measured, kCount, kTurnCount, kPeriod);
  // Of the count between the two, a first-order way of 0.25 s.
  EXPECT_NEAR(pose.position.y, (8.0 + kPeriod / 0.25) * kCount, 1e-12);
  EXPECT_NEAR(turn_between(kNoTurn, pose.rotation).y, (8.0 + kPeriod / 0.25) * kTurnCount, 1e-12);
  for (int i = 1; i < 250; ++i) {
    pose = follow_counts(pose, measured, kCount, kTurnCount, kPeriod);
  }
  // (1 - x)^(1 / x) is less than e^-1 by a share of x / 2 and a little.
  const double left = std::exp(-1.0);
  const double error = kPeriod / 0.25 * left;
  EXPECT_NEAR(pose.position.y, (9.0 - left) * kCount, error * kCount);
  EXPECT_NEAR(turn_between(kNoTurn, pose.rotation).y, (9.0 - left) * kTurnCount,
              error * kTurnCount);
}

TEST(CountPlayTest, LiesWithinTwoAndAHalfCountsOfTheHandleOnEveryWay) {
  Pose pose;
  for (int i = 0; i < 5000; ++i) {
    const double y = 20.0 * kCount * std::sin(0.01 * i);
    const double angle = 20.0 * kTurnCount * std::sin(0.007 * i);
    const Pose measured = said(y, angle);
    pose = follow_counts(pose, measured, kCount, kTurnCount, kPeriod);
    // Two counts from what is said, which is half a count from the handle.
    EXPECT_LE(std::abs(pose.position.y - measured.position.y), 2.0 * kCount * (1.0 + 1e-9));
    EXPECT_LE(std::abs(pose.position.y - y), 2.5 * kCount * (1.0 + 1e-9));
    EXPECT_LE(std::abs(turn_between(kNoTurn, pose.rotation).y - angle),
              2.5 * kTurnCount * (1.0 + 1e-6));
  }
}

struct Toggling {
  double force = 0.0;   // N: mean over the last second
  double ripple = 0.0;  // N: largest less smallest there
};

/// A hand of `grip` pushes its handle against a coupling of 200 N/m to something hard, which knows
/// the handle by 8 bits over 100 mm and acts 4 ms late.
Toggling held_by(double grip, double wanted, bool follows) {
  constexpr double kStiffness = 200.0;  // N/m
  constexpr double kCoarse = 0.1 / 256.0;
  constexpr double kMass = 0.15;    // kg
  constexpr double kDamping = 6.0;  // N s/m
  constexpr std::size_t kSteps = 6000;
  constexpr int kParts = 20;  // of a period, as semi-implicit Euler
  std::array<double, 5> late{};
  double y = 0.0;
  double velocity = 0.0;
  Pose pose;
  Toggling outcome;
  double lowest = 1e30;
  double highest = -1e30;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const Pose measured{{0.0, std::round(y / kCoarse) * kCoarse, 0.0}, kNoTurn};
    pose = follows ? follow_counts(pose, measured, kCoarse, 0.0, kPeriod) : measured;
    late[i % 5] = -kStiffness * pose.position.y;
    const double force = late[(i + 1) % 5];
    for (int part = 0; part < kParts; ++part) {
      velocity += (force + grip * (wanted - y) - kDamping * velocity) / kMass * (kPeriod / kParts);
      y += velocity * (kPeriod / kParts);
    }
    if (i >= kSteps - 1000) {
      outcome.force += force / 1000.0;
      lowest = std::min(lowest, force);
      highest = std::max(highest, force);
    }
  }
  outcome.ripple = highest - lowest;
  return outcome;
}

TEST(CountPlayTest, NoHandTogglesTheForceOfACoupling) {
  int toggled = 0;
  for (const double grip : {50.0, 200.0, 1000.0}) {
    // Where the handle comes to rest in a count, that is every place in one.
    const double span = 0.1 / 256.0 * (1.0 + 200.0 / grip);  // m
    for (int i = 0; i < 40; ++i) {
      const double wanted = 5.0 * span + span * i / 40.0;
      const Toggling still = held_by(grip, wanted, true);
      EXPECT_LT(still.ripple, 0.01 * std::abs(still.force)) << grip << " N/m, " << wanted << " m";
      toggled += held_by(grip, wanted, false).ripple > 0.07 ? 1 : 0;  // a count is 0.078 N
    }
  }
  EXPECT_GT(toggled, 0) << "this would show no toggling";
}

TEST(CountPlayTest, WhatDoesNotCountIsTakenAsItIs) {
  const Pose measured{{0.1, 0.2, 0.3}, glm::angleAxis(0.4, glm::dvec3(1.0, 0.0, 0.0))};
  const Pose pose = follow_counts({}, measured, 0.0, 0.0, kPeriod);
  EXPECT_EQ(pose.position, measured.position);
  EXPECT_EQ(pose.rotation, measured.rotation);
}

}  // namespace
}  // namespace torsion::engine
