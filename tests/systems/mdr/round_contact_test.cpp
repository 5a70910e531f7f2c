#include "systems/mdr/round_contact.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

constexpr double kModulus = 3e5;  // E*, Pa
constexpr double kRadius = 0.02;  // m, of a ball or a flat punch

RoundContact ball_at(double depth) {
  RoundContact contact;
  contact.depth = depth;
  contact.radius = std::sqrt(kRadius * depth);
  contact.force = 4.0 / 3.0 * kModulus * contact.radius * depth;
  return contact;
}

RoundContact punch_at(double depth) {
  RoundContact contact;
  contact.depth = depth;
  contact.radius = kRadius;
  contact.force = 2.0 * kModulus * kRadius * depth;
  return contact;
}

RoundContact cone_at(double depth) {
  RoundContact contact;  // of 45 degrees: Popov and Hess, 2015, 2.3
  contact.depth = depth;
  contact.radius = 2.0 / std::numbers::pi * depth;
  contact.force = 2.0 / std::numbers::pi * kModulus * depth * depth;
  return contact;
}

// Each profile's force and radius go with a power of the depth, however far.
TEST(RoundContactTest, ContactsAtAnotherDepthAreThoseOfTheirProfile) {
  for (const auto at : {ball_at, punch_at, cone_at}) {
    for (const double share : {1e-3, 0.5, 1.0, 3.0}) {
      const RoundContact found = pressed_to(share * 1e-3, kModulus, at(1e-3));
      const RoundContact exact = at(share * 1e-3);
      EXPECT_NEAR(found.force, exact.force, 1e-12 * exact.force);
      EXPECT_NEAR(found.radius, exact.radius, 1e-12 * exact.radius);
      EXPECT_EQ(found.depth, exact.depth);
    }
  }
}

TEST(RoundContactTest, SlopeIsTheForcesChange) {
  constexpr double kDepth = 1e-3;
  constexpr double kStep = 1e-6 * kDepth;
  for (const auto at : {ball_at, punch_at, cone_at}) {
    const double change = at(kDepth + kStep).force - at(kDepth - kStep).force;
    const double slope = normal_slope(at(kDepth), kModulus);
    EXPECT_NEAR(change / (2.0 * kStep), slope, 1e-8 * slope);
  }
}

}  // namespace
}  // namespace torsion::engine
