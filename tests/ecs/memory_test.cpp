#include "ecs/memory.hpp"

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

TEST(MemoryTest, GrowsByARowOfEveryColumn) {
  World world;
  const std::size_t before = memory_of(world);
  world.state.cells.reserve(5);
  const std::size_t five = memory_of(world) - before;
  EXPECT_EQ(five, 5 * (sizeof(CellGeometry) + sizeof(CellTraction)));
  World larger;
  larger.state.cells.reserve(15);
  larger.model.tools.reserve(2);
  EXPECT_EQ(memory_of(larger) - before,
            3 * five + 2 * (sizeof(MassProperties) + sizeof(OwnedRows) + sizeof(Bounds)));
}

}  // namespace
}  // namespace torsion::engine
