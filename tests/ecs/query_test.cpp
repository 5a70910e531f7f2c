#include "ecs/query.hpp"

#include <span>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "ecs/world.hpp"
#include "tests/ecs/small_world.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion {
namespace {

TEST(QueryTest, VisitsTheTablesThatHaveAllComponentsInOrder) {
  World world = test::small_world(1);
  std::vector<const OwnedRows*> visited;
  each<const Entity, const OwnedRows, const Bounds>(
      world, [&visited](std::span<const Entity> entities, std::span<const OwnedRows> owned,
                        std::span<const Bounds> bounds) {
        EXPECT_EQ(entities.size(), owned.size());
        EXPECT_EQ(entities.size(), bounds.size());
        visited.push_back(owned.data());
      });
  const std::vector<const OwnedRows*> expected = {world.bodies.column<OwnedRows>().data(),
                                                  world.tools.column<OwnedRows>().data()};
  EXPECT_EQ(visited, expected);
}

TEST(QueryTest, ComponentsOfDifferentTablesMatchNothing) {
  World world = test::small_world(1);
  int visits = 0;
  each<RegionFrame, ToolPose>(world, [&visits](auto /*frames*/, auto /*poses*/) { visits += 1; });
  EXPECT_EQ(visits, 0);
}

TEST(QueryTest, WritesReachTheTable) {
  World world = test::small_world(1);
  each<const Entity, ToolPose>(world, [](std::span<const Entity>, std::span<ToolPose> poses) {
    poses[1].now.position = {1.0, 2.0, 3.0};
  });
  EXPECT_EQ(world.tools.at<ToolPose>(1).now.position, glm::dvec3(1.0, 2.0, 3.0));
}

TEST(QueryTest, AConstWorldGivesConstRows) {
  const World world = test::small_world(1);
  std::size_t rows = 0;
  each<const AnchorRest>(world, [&rows](auto anchors) {
    static_assert(std::is_same_v<decltype(anchors), std::span<const AnchorRest>>);
    rows += anchors.size();
  });
  EXPECT_EQ(rows, 6U);
}

TEST(QueryTest, AllocatesNothing) {
  World world = test::small_world(1);
  const test::AllocationGuard guard;
  double sum = 0.0;
  each<const CellGeometry, CellTraction>(
      world, [&sum](std::span<const CellGeometry> geometry, std::span<CellTraction> traction) {
        sum += geometry[0].depth * traction[0].pressure;
      });
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace torsion
