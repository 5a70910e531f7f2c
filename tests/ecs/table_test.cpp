#include "ecs/table.hpp"

#include <cstdint>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

struct Mass {
  float value = 1.0F;
};
struct Place {
  double x = 0.0;
  double y = 0.0;
};
using Masses = Table<Mass, Place>;

Masses things(std::uint32_t rows, std::uint32_t capacity) {
  Masses table;
  table.reserve(capacity);
  table.append(rows);
  for (std::uint32_t row = 0; row < rows; ++row) {
    table.at<Mass>(row).value = static_cast<float>(row);
    table.at<Place>(row).x = 10.0 * row;
  }
  return table;
}

TEST(TableTest, EveryColumnIsAlignedToACacheLine) {
  const Masses table = things(1, 5);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(table.column<Mass>().data()) % 64, 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(table.column<Place>().data()) % 64, 0U);
}

TEST(TableTest, AppendedRowsAreZeroEvenWhereARowWasBefore) {
  Masses table = things(3, 3);
  table.clear();
  const Range rows = table.append(2).value();
  EXPECT_EQ(rows, (Range{0, 2}));
  EXPECT_EQ(table.at<Mass>(1).value, 0.0F);
  EXPECT_EQ(table.at<Place>(1).x, 0.0);
}

TEST(TableTest, AppendBeyondTheCapacityChangesNothing) {
  Masses table = things(2, 3);
  EXPECT_FALSE(table.append(2).has_value());
  EXPECT_EQ(table.size(), 2U);
  EXPECT_TRUE(table.append(1).has_value());
  EXPECT_FALSE(table.append(1).has_value());
  EXPECT_FALSE(table.append(UINT32_MAX).has_value());
}

TEST(TableTest, EraseKeepsTheOrderInEveryColumn) {
  Masses table = things(4, 4);
  table.erase(1);
  ASSERT_EQ(table.size(), 3U);
  const float masses[] = {0.0F, 2.0F, 3.0F};
  for (std::uint32_t row = 0; row < 3; ++row) {
    EXPECT_EQ(table.at<Mass>(row).value, masses[row]);
    EXPECT_EQ(table.at<Place>(row).x, 10.0 * static_cast<double>(masses[row]));
  }
  table.erase(2);
  EXPECT_EQ(table.size(), 2U);
  EXPECT_EQ(table.at<Mass>(1).value, 2.0F);
}

TEST(TableTest, ColumnsStayWhereTheyAre) {
  Masses table = things(1, 100);
  const Mass* const before = table.column<Mass>().data();
  table.append(99);
  table.erase(0);
  table.clear();
  EXPECT_EQ(table.column<Mass>().data(), before);
}

TEST(TableTest, NoRowsNeedNoMemory) {
  Masses table;
  table.reserve(0);
  EXPECT_TRUE(table.append(0).has_value());
  EXPECT_FALSE(table.append(1).has_value());
  EXPECT_TRUE(table.column<Place>().empty());
}

TEST(TableTest, CopiedRowsAreEqual) {
  const Masses from = things(3, 3);
  Masses to;
  to.reserve(5);
  to.append(5);
  to.copy_rows(from);
  ASSERT_EQ(to.size(), 3U);
  EXPECT_EQ(to.at<Place>(2).x, 20.0);
}

TEST(TableTest, OnlyReserveAllocates) {
  Masses table;
  table.reserve(50);
  Masses other = things(50, 50);
  const test::AllocationGuard guard;
  table.append(20);
  table.erase(3);
  table.append(31);
  table.clear();
  table.copy_rows(other);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.releases(), 0U);
}

TEST(TableDeathTest, ARowThatIsNotThereStopsTheProgram) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  Masses table = things(2, 8);
  EXPECT_DEATH(static_cast<void>(table.at<Mass>(2)), "assertion failed");
  EXPECT_DEATH(static_cast<void>(table.rows<Mass>({1, 2})), "assertion failed");
  EXPECT_DEATH(table.erase(2), "assertion failed");
}

}  // namespace
}  // namespace torsion::engine
