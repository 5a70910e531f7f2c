#include "ecs/commands.hpp"

#include <gtest/gtest.h>

#include "ecs/check_world.hpp"
#include "tests/ecs/small_world.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion {
namespace {

struct Weight {
  double value = 0.0;
};
using Things = Table<Entity, Weight>;

class CommandsTest : public testing::Test {
 protected:
  void SetUp() override {
    things_.reserve(3);
    pool_.reserve(3);
    commands_.reserve(8);
    for (const double weight : {1.0, 2.0}) {
      add(weight);
    }
    commands_.apply(things_, pool_);
  }

  void add(double weight) {
    commands_.staged().at<Weight>(commands_.create().value()).value = weight;
  }

  Things things_;
  EntityPool pool_;
  Commands<Things> commands_;
};

TEST_F(CommandsTest, NothingChangesBeforeApply) {
  add(3.0);
  commands_.destroy(things_.at<Entity>(0));
  EXPECT_EQ(things_.size(), 2U);
  EXPECT_TRUE(pool_.row(things_.at<Entity>(0)).has_value());
}

TEST_F(CommandsTest, CommandsAreCarriedOutInRecordingOrder) {
  // The table has room for one more row: a destroy recorded first makes room for the second create,
  // one recorded after it comes too late.
  commands_.destroy(things_.at<Entity>(0));
  add(3.0);
  add(4.0);
  add(5.0);
  const auto applied = commands_.apply(things_, pool_);
  EXPECT_EQ(applied.destroyed, 1U);
  EXPECT_EQ(applied.created, 2U);
  EXPECT_EQ(applied.refused, 1U);
  ASSERT_EQ(things_.size(), 3U);
  EXPECT_EQ(things_.at<Weight>(0).value, 2.0);
  EXPECT_EQ(things_.at<Weight>(1).value, 3.0);
  EXPECT_EQ(things_.at<Weight>(2).value, 4.0);
}

TEST_F(CommandsTest, HandlesFollowTheirRows) {
  const Entity second = things_.at<Entity>(1);
  commands_.destroy(things_.at<Entity>(0));
  add(3.0);
  commands_.apply(things_, pool_);
  EXPECT_EQ(pool_.row(second), 0U);
  EXPECT_EQ(pool_.row(things_.at<Entity>(1)), 1U);
}

TEST_F(CommandsTest, DestroyingTwiceIsStaleTheSecondTime) {
  const Entity first = things_.at<Entity>(0);
  commands_.destroy(first);
  commands_.destroy(first);
  const auto applied = commands_.apply(things_, pool_);
  EXPECT_EQ(applied.destroyed, 1U);
  EXPECT_EQ(applied.stale, 1U);
  EXPECT_EQ(things_.size(), 1U);
  EXPECT_TRUE(commands_.empty());
}

TEST_F(CommandsTest, MoreThanWasReservedIsRefused) {
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(commands_.destroy(Entity{}));
  }
  EXPECT_FALSE(commands_.destroy(Entity{}));
  EXPECT_FALSE(commands_.create().has_value());
}

TEST_F(CommandsTest, OnlyReserveAllocates) {
  const test::AllocationGuard guard;
  for (int turn = 0; turn < 20; ++turn) {
    commands_.destroy(things_.at<Entity>(0));
    add(turn);
    commands_.apply(things_, pool_);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.releases(), 0U);
}

TEST(RegionCommandsTest, RegionsCarryTheirHandleInTheirIdentity) {
  World world = test::small_world(1);
  Commands<RegionTable> commands;
  commands.reserve(4);
  const Entity survivor = world.regions.at<RegionIdentity>(1).self;
  commands.destroy(world.regions.at<RegionIdentity>(0).self);
  const std::uint32_t staged = commands.create().value();
  commands.staged().at<RegionIdentity>(staged).order = 77;
  commands.apply(world.regions, world.region_handles);
  ASSERT_EQ(world.regions.size(), 2U);
  EXPECT_EQ(world.region_handles.row(survivor), 0U);
  EXPECT_EQ(world.regions.at<RegionIdentity>(1).order, 77U);
  EXPECT_TRUE(check_world(world).ok());
}

}  // namespace
}  // namespace torsion
