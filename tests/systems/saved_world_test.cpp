#include <gtest/gtest.h>

#include "ecs/hash.hpp"
#include "ecs/state_io.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion {
namespace {

/// Presses, turns and slides, so that every table has something to carry over.
Pose pose_at(int step) {
  const double t = static_cast<double>(step) / 1000.0;
  const double depth = 6e-4 * std::min(1.0, 5.0 * t);
  return {glm::dvec3(0.01 * std::max(0.0, t - 0.4), 0.15 + 1e-4 - depth, 0.0),
          glm::angleAxis(0.8 * std::max(0.0, t - 0.2), glm::dvec3(0.0, 1.0, 0.0))};
}

TEST(SavedWorldTest, AWorldLoadedHalfWayGoesOnToTheBit) {
  constexpr int kHalf = 500;
  constexpr int kEnd = 1000;
  test::Hand hand(test::ball_on_cube());
  for (int step = 0; step < kHalf; ++step) {
    hand.step_to({pose_at(step)});
  }
  ASSERT_EQ(hand.world().regions.size(), 1U);
  const std::vector<std::byte> saved = to_bytes(hand.world());

  // Another simulation of the same scene takes the world over: all that a step knows is in it.
  test::Hand other(test::ball_on_cube());
  Result<World> loaded = from_bytes(saved, "memory");
  ASSERT_TRUE(loaded.ok()) << loaded.error().text;
  other.simulation().world = std::move(loaded).value();
  EXPECT_EQ(hash(other.world()), hash(hand.world()));
  for (int step = kHalf; step < kEnd; ++step) {
    hand.step_to({pose_at(step)});
    other.step_to({pose_at(step)});
    ASSERT_EQ(hash(other.world()), hash(hand.world())) << "after step " << step;
  }
  EXPECT_GT(glm::length(hand.wrench().torque), 0.0);
}

}  // namespace
}  // namespace torsion
