#include <gtest/gtest.h>

#include "systems/scratch.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine {
namespace {

using test::Hand;

std::vector<std::string_view> names_on(Hand& hand) {
  std::vector<std::string_view> names;
  for (const auto& row : hand.simulation().scratch->schedule.rows()) {
    if (row.on) {
      names.push_back(row.system.name);
    }
  }
  return names;
}

bool runs(Hand& hand, std::string_view name) {
  hand.step_to({{glm::dvec3(0.0, 0.2, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  for (const auto& row : hand.simulation().scratch->schedule.rows()) {
    if (row.system.name == name) {
      EXPECT_EQ(row.on, row.timing.runs > 0) << name;
      return row.timing.runs > 0;
    }
  }
  ADD_FAILURE() << "no system " << name;
  return false;
}

TEST(ScheduleOfScenesTest, TheWholeSceneRunsEverySystemButThoseOfOtherContactModels) {
  Hand hand(test::ball_on_cube());
  EXPECT_EQ(names_on(hand).size(), step_systems().size() - 4);
  EXPECT_TRUE(runs(hand, "paper_friction_forces"));
  EXPECT_TRUE(runs(hand, "main_beams"));
  EXPECT_FALSE(runs(hand, "mdr_forces"));
  EXPECT_FALSE(runs(hand, "patch_forces"));
}

TEST(ScheduleOfScenesTest, OnlyTheSystemOfTheChosenContactModelRuns) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].models = {ContactModel::kPatch, BodyModel::kNone};
  Hand cells(scene);
  EXPECT_TRUE(runs(cells, "patch_forces"));
  EXPECT_FALSE(runs(cells, "mdr_forces"));
  EXPECT_FALSE(runs(cells, "paper_normal_forces"));
  EXPECT_FALSE(runs(cells, "carry_tractions"));
  scene.bodies[0].models.contact = ContactModel::kMdr;
  Hand springs(scene);
  EXPECT_TRUE(runs(springs, "mdr_forces"));
  EXPECT_FALSE(runs(springs, "patch_forces"));
  EXPECT_EQ(springs.world().state.patch_cells.size(), 0U);
}

TEST(ScheduleOfScenesTest, WithoutFrictionNothingOfFrictionRuns) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].friction = {0.0, 0.0};
  Hand hand(scene);
  EXPECT_FALSE(runs(hand, "region_motion"));
  EXPECT_FALSE(runs(hand, "paper_friction_forces"));
  EXPECT_TRUE(runs(hand, "paper_normal_forces"));
}

TEST(ScheduleOfScenesTest, ABodyModelNoneLeavesTheSkeletonOut) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].models.body = BodyModel::kNone;
  Hand hand(scene);
  EXPECT_FALSE(runs(hand, "main_beams"));
  EXPECT_TRUE(runs(hand, "paper_friction_forces"));
  EXPECT_EQ(hand.world().model.anchors.size(), 0U);
}

}  // namespace
}  // namespace torsion::engine
