#include "systems/held_tool/count_play.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/rotation_vector.hpp"

namespace torsion {
namespace {

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
  for (const int i : {0, 1, 2, 1, 2, 1, 1, 2}) {
    pose = within_a_count(pose, said(i * kCount, i * kTurnCount), kCount, kTurnCount);
    // It follows to where it is within a count of the farthest, and no more.
    const double expected = i == 2 || pose.position.y > 0.0 ? 1.0 : 0.0;
    EXPECT_NEAR(pose.position.y, expected * kCount, 1e-15);
    EXPECT_NEAR(turn_between(kNoTurn, pose.rotation).y, expected * kTurnCount, 1e-12);
  }
  EXPECT_GT(pose.position.y, 0.0);
}

TEST(CountPlayTest, LiesWithinOneAndAHalfCountsOfTheHandleOnEveryWay) {
  Pose pose;
  for (int i = 0; i < 5000; ++i) {
    const double y = 20.0 * kCount * std::sin(0.01 * i);
    const double angle = 20.0 * kTurnCount * std::sin(0.007 * i);
    const Pose measured = said(y, angle);
    pose = within_a_count(pose, measured, kCount, kTurnCount);
    // A count from what is said, which is half a count from the handle.
    EXPECT_LE(std::abs(pose.position.y - measured.position.y), kCount * (1.0 + 1e-9));
    EXPECT_LE(std::abs(pose.position.y - y), 1.5 * kCount * (1.0 + 1e-9));
    EXPECT_LE(std::abs(turn_between(kNoTurn, pose.rotation).y - angle),
              1.5 * kTurnCount * (1.0 + 1e-6));
  }
}

TEST(CountPlayTest, WhatDoesNotCountIsTakenAsItIs) {
  const Pose measured{{0.1, 0.2, 0.3}, glm::angleAxis(0.4, glm::dvec3(1.0, 0.0, 0.0))};
  const Pose pose = within_a_count({}, measured, 0.0, 0.0);
  EXPECT_EQ(pose.position, measured.position);
  EXPECT_EQ(pose.rotation, measured.rotation);
}

}  // namespace
}  // namespace torsion
