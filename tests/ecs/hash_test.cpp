#include "ecs/hash.hpp"

#include <cstddef>
#include <span>

#include <gtest/gtest.h>

#include "tests/ecs/small_world.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

TEST(HashTest, EqualWorldsHaveEqualHashes) {
  EXPECT_EQ(hash(test::small_world(1)), hash(test::small_world(1)));
  EXPECT_NE(hash(test::small_world(1)), hash(test::small_world(2)));
}

// Flips the lowest bit of the last byte of one column and puts it back.
void expect_hash_to_change(const World& world, std::span<std::byte> column) {
  ASSERT_FALSE(column.empty());
  const std::uint64_t before = hash(world);
  column.back() ^= std::byte{1};
  EXPECT_NE(hash(world), before);
  column.back() ^= std::byte{1};
  EXPECT_EQ(hash(world), before);
}

TEST(HashTest, EveryColumnOfEveryTableCounts) {
  World world = test::small_world(3);
  const auto change_each = [&world](auto&... tables) {
    (tables.each_column([&world](std::span<std::byte> bytes, std::size_t /*row_size*/) {
      expect_hash_to_change(world, bytes);
    }),
     ...);
  };
  std::apply(change_each, world.model.tables());
  std::apply(change_each, world.state.tables());
  expect_hash_to_change(world, std::as_writable_bytes(std::span(&world.model.settings, 1)));
  expect_hash_to_change(world, std::as_writable_bytes(std::span(&world.model.dt, 1)));
  expect_hash_to_change(world, std::as_writable_bytes(std::span(&world.state.clock, 1)));
}

TEST(HashTest, AColumnThatChangesIsNamed) {
  World world = test::small_world(3);
  const ColumnHashes before = hash_columns(world.state);
  EXPECT_TRUE(differing(before, hash_columns(world.state)).empty());
  world.state.regions.at<RegionNormal>(0).force = 12345.0;
  world.state.cells.at<CellTraction>(1).pressure = 12345.0;
  EXPECT_EQ(differing(before, hash_columns(world.state)), (columns<RegionNormal, CellTraction>()));
  EXPECT_EQ(kColumnNames[column_number<RegionNormal>()], "RegionNormal");
}

TEST(HashTest, RowsBeyondTheSizeDoNotCount) {
  World world = test::small_world(4);
  const std::uint64_t before = hash(world);
  ASSERT_TRUE(world.state.regions.append(1).has_value());
  world.state.regions.at<RegionNormal>(world.state.regions.size() - 1).force = 1.0;
  EXPECT_NE(hash(world), before);
  world.state.regions.erase(world.state.regions.size() - 1);
  EXPECT_EQ(hash(world), before);
}

TEST(HashTest, AllocatesNothing) {
  const World world = test::small_world(5);
  const test::AllocationGuard guard;
  const std::uint64_t value = hash(world);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_NE(value, 0U);
}

}  // namespace
}  // namespace torsion::engine
