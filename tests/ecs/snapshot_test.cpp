#include "ecs/snapshot.hpp"

#include <cstring>
#include <span>

#include <gtest/gtest.h>

#include "tests/ecs/small_world.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion {
namespace {

template <class T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(SnapshotTest, HoldsWhatTheWorldHeldAtCapture) {
  World world = test::small_world(1);
  const World as_it_was = test::small_world(1);
  Snapshot snapshot;
  snapshot.reserve(world);
  capture(world, snapshot);
  world.tools.at<ToolPose>(0).now.position = glm::dvec3(1.0);
  world.regions.erase(0);
  world.clock.at<Clock>(0).step += 1;

  const World& before = as_it_was;
  const Snapshot& seen = snapshot;
  EXPECT_TRUE(same_bytes(seen.clock.column<Clock>(), before.clock.column<Clock>()));
  EXPECT_TRUE(same_bytes(seen.tools.column<ToolPose>(), before.tools.column<ToolPose>()));
  EXPECT_TRUE(same_bytes(seen.tools.column<ToolWrench>(), before.tools.column<ToolWrench>()));
  EXPECT_TRUE(same_bytes(seen.regions.column<RegionFrame>(), before.regions.column<RegionFrame>()));
  EXPECT_TRUE(
      same_bytes(seen.regions.column<RegionWrench>(), before.regions.column<RegionWrench>()));
  EXPECT_EQ(seen.region_fields.size(), before.regions.size());
  EXPECT_EQ(seen.anchors.size(), before.anchors.size());
}

TEST(SnapshotTest, RegionsMayComeAndGoBetweenCapturesWithoutAllocating) {
  World world = test::small_world(2);
  Snapshot snapshot;
  snapshot.reserve(world);
  const test::AllocationGuard guard;
  capture(world, snapshot);
  world.regions.append(2);
  capture(world, snapshot);
  EXPECT_EQ(snapshot.regions.size(), 4U);
  world.regions.clear();
  capture(world, snapshot);
  EXPECT_EQ(snapshot.regions.size(), 0U);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace torsion
