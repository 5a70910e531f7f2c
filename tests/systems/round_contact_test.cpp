#include "systems/contact_models/round_contact.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace torsion {
namespace {

constexpr double kModulus = 3e5;  // E*, Pa
constexpr double kRadius = 0.02;  // m, of a ball

RoundContact ball_at(double depth) {
  RoundContact contact;
  contact.depth = depth;
  contact.radius = std::sqrt(kRadius * depth);
  contact.force = 4.0 / 3.0 * kModulus * contact.radius * depth;
  return contact;
}

// Hertz' contact on a spring, whose own contact is the one that much less deep.
TEST(RoundContactTest, ABallOnABodyThatGivesWayIsHertzInSeriesWithIt) {
  for (const double depth : {1e-6, 1e-4, 2e-3}) {
    const RoundContact free = ball_at(depth);
    for (const double share : {1e-3, 0.3, 1.0, 30.0, 1e4}) {
      const double compliance = share * depth / free.force;
      for (const double known : {0.0, 0.1 * free.force / (1.0 + share)}) {
        const RoundContact found = give_way({compliance, known, 0.0}, kModulus, free);
        const double left = depth - compliance * (found.force - known);
        const RoundContact expected = ball_at(left);
        // What is left of a body that gives way by much is a difference of its motions.
        const double rounding = 1e-11 * (1.0 + share);
        EXPECT_NEAR(found.force, expected.force, rounding * expected.force) << share;
        EXPECT_NEAR(found.depth, left, rounding * left);
        EXPECT_NEAR(found.radius, expected.radius, rounding * expected.radius);
      }
    }
  }
}

TEST(RoundContactTest, ABodyThatComesAfterTheToolKeepsTheContact) {
  // It had given way to more than what this depth asks for: the contact is deeper than it is seen.
  const RoundContact seen = ball_at(1e-4);
  const RoundContact before = ball_at(2e-4);
  const double compliance = 1e-4 / before.force;
  const RoundContact found = give_way({compliance, before.force, 0.0}, kModulus, seen);
  EXPECT_GT(found.depth, seen.depth);
  EXPECT_NEAR(found.force, ball_at(found.depth).force, 1e-12 * found.force);
  EXPECT_NEAR(found.depth, seen.depth + compliance * (before.force - found.force), 1e-15);
}

TEST(RoundContactTest, LoadsBesideItMayTakeTheContactAway) {
  const RoundContact seen = ball_at(1e-4);
  EXPECT_EQ(give_way({0.0, 0.0, -2e-4}, kModulus, seen).force, 0.0);
  const RoundContact half = give_way({0.0, 0.0, -0.5e-4}, kModulus, seen);
  EXPECT_NEAR(half.force, ball_at(0.5e-4).force, 1e-12 * half.force);
}

}  // namespace
}  // namespace torsion
