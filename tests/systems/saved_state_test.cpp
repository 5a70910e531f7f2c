#include <array>

#include <gtest/gtest.h>

#include "ecs/hash.hpp"
#include "ecs/state_io.hpp"
#include "systems/scratch.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine {
namespace {

/// Presses, turns and slides, so that every table has something to carry over.
Pose pose_at(int step) {
  const double t = static_cast<double>(step) / 1000.0;
  const double depth = 6e-4 * std::min(1.0, 5.0 * t);
  return {glm::dvec3(0.01 * std::max(0.0, t - 0.4), 0.15 + 1e-4 - depth, 0.0),
          glm::angleAxis(0.8 * std::max(0.0, t - 0.2), glm::dvec3(0.0, 1.0, 0.0))};
}

TEST(SavedStateTest, AStateLoadedHalfWayGoesOnToTheBit) {
  constexpr int kHalf = 500;
  constexpr int kEnd = 1000;
  test::Hand hand(test::ball_on_cube());
  for (int step = 0; step < kHalf; ++step) {
    hand.step_to({pose_at(step)});
  }
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  const std::vector<std::byte> saved = to_bytes(hand.world().model, hand.world().state);

  // Another simulation of the same scene takes the state over: all that a step changes is in it.
  test::Hand other(test::ball_on_cube());
  Result<State> loaded = from_bytes(saved, other.world().model, "memory");
  ASSERT_TRUE(loaded.ok()) << loaded.error().text;
  other.simulation().world.state = std::move(loaded).value();
  EXPECT_EQ(hash(other.world()), hash(hand.world()));
  for (int step = kHalf; step < kEnd; ++step) {
    hand.step_to({pose_at(step)});
    other.step_to({pose_at(step)});
    ASSERT_EQ(hash(other.world()), hash(hand.world())) << "after step " << step;
  }
  EXPECT_GT(glm::length(hand.wrench().torque), 0.0);
}

// With every pair of models: a copy goes on as the first one does, and another way of its own
// disturbs nothing.
TEST(CopiedStateTest, TwoCopiesWithDifferentPosesDoNotDisturbEachOther) {
  for (const ContactModel contact :
       {ContactModel::kPaper, ContactModel::kMdr, ContactModel::kPatch, ContactModel::kWinkler}) {
    for (const BodyModel body : {BodyModel::kNone, BodyModel::kSkeleton, BodyModel::kCompliance}) {
      SceneDescription scene = test::ball_on_cube();
      scene.bodies[0].models.contact = contact;
      scene.bodies[0].models.body = body;
      const Result<Simulation> prepared = prepare(scene, PrepareOptions{});
      ASSERT_TRUE(prepared);
      const Model& model = prepared.value().world.model;
      State state = prepared.value().world.state;
      Scratch scratch;
      scratch.reserve(model, state);
      Scratch other_scratch;
      other_scratch.reserve(model, state);
      const std::uint64_t of_model = hash(model);
      for (int at = 0; at < 250; ++at) {
        step(model, state, std::array{pose_at(at)}, scratch);
      }
      State copy = state;
      State other = state;
      ASSERT_EQ(hash(copy), hash(state));
      for (int at = 250; at < 300; ++at) {
        step(model, state, std::array{pose_at(at)}, scratch);
        step(model, other, std::array{pose_at(500 - at)}, other_scratch);
      }
      for (int at = 250; at < 300; ++at) {
        step(model, copy, std::array{pose_at(at)}, scratch);
      }
      EXPECT_EQ(hash(copy), hash(state)) << "contact model " << static_cast<int>(contact)
                                         << ", body model " << static_cast<int>(body);
      EXPECT_NE(hash(other), hash(state));
      EXPECT_EQ(hash(model), of_model);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
