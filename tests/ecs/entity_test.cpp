#include "ecs/entity.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"

namespace torsion {
namespace {

TEST(EntityPoolTest, AHandleLeadsToItsRow) {
  EntityPool pool;
  pool.reserve(2);
  const Entity first = pool.create(7).value();
  const Entity second = pool.create(9).value();
  EXPECT_NE(first, second);
  EXPECT_EQ(pool.row(first), 7U);
  EXPECT_EQ(pool.row(second), 9U);
}

TEST(EntityPoolTest, AStaleHandleIsCaughtAlsoWhenItsSlotIsTakenAgain) {
  EntityPool pool;
  pool.reserve(1);
  const Entity old = pool.create(0).value();
  EXPECT_TRUE(pool.destroy(old));
  EXPECT_FALSE(pool.row(old).has_value());
  EXPECT_FALSE(pool.destroy(old));
  EXPECT_FALSE(pool.move(old, 3));

  const Entity young = pool.create(5).value();
  EXPECT_EQ(young.slot, old.slot);
  EXPECT_FALSE(pool.row(old).has_value());
  EXPECT_FALSE(pool.destroy(old));
  EXPECT_EQ(pool.row(young), 5U);
}

TEST(EntityPoolTest, NeverValidHandlesNameNothing) {
  EntityPool pool;
  pool.reserve(2);
  EXPECT_FALSE(pool.row(Entity{}).has_value());
  EXPECT_FALSE(pool.row(Entity{0, 0}).has_value());
  EXPECT_FALSE(pool.row(Entity{0, 1}).has_value());
  EXPECT_FALSE(pool.row(Entity{2, 1}).has_value());
}

TEST(EntityPoolTest, AFullPoolRefuses) {
  EntityPool pool;
  EXPECT_FALSE(pool.create(0).has_value());
  pool.reserve(1);
  const Entity only = pool.create(0).value();
  EXPECT_FALSE(pool.create(1).has_value());
  pool.destroy(only);
  EXPECT_TRUE(pool.create(1).has_value());
}

TEST(EntityPoolTest, MovedRowsAreFound) {
  EntityPool pool;
  pool.reserve(1);
  const Entity thing = pool.create(4).value();
  EXPECT_TRUE(pool.move(thing, 3));
  EXPECT_EQ(pool.row(thing), 3U);
}

// Against a plain list of what is alive, over a few thousand random births and deaths.
TEST(EntityPoolTest, AgreesWithAPlainListAndAllocatesNothing) {
  constexpr std::uint32_t kCapacity = 16;
  EntityPool pool;
  pool.reserve(kCapacity);
  struct Known {
    Entity entity;
    std::uint32_t row;
  };
  std::vector<Known> alive;
  std::vector<Entity> dead;
  alive.reserve(kCapacity);
  dead.reserve(4000);
  std::mt19937 random(1);  // the same run every time
  const test::AllocationGuard guard;
  for (std::uint32_t turn = 0; turn < 4000; ++turn) {
    if (random() % 2 == 0) {
      const auto entity = pool.create(turn);
      ASSERT_EQ(entity.has_value(), alive.size() < kCapacity);
      if (entity) {
        alive.push_back({*entity, turn});
      }
    } else if (!alive.empty()) {
      const std::size_t victim = random() % alive.size();
      ASSERT_TRUE(pool.destroy(alive[victim].entity));
      dead.push_back(alive[victim].entity);
      alive[victim] = alive.back();
      alive.pop_back();
    }
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_TRUE(std::ranges::all_of(
      alive, [&pool](const Known& known) { return pool.row(known.entity) == known.row; }));
  EXPECT_TRUE(std::ranges::none_of(
      dead, [&pool](const Entity& entity) { return pool.row(entity).has_value(); }));
}

}  // namespace
}  // namespace torsion
