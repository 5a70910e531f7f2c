#include "ecs/snapshot.hpp"

#include <cstring>
#include <span>

#include <gtest/gtest.h>

#include "tests/ecs/small_world.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

template <class T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(SnapshotTest, HoldsWhatTheWorldHeldAtCapture) {
  World world = test::small_world(1);
  const World as_it_was = test::small_world(1);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  capture(world.model, world.state, snapshot);
  world.state.tools.at<ToolPose>(0).now.position = glm::dvec3(1.0);
  world.state.regions.erase(0);
  world.state.clock.step += 1;

  const World& before = as_it_was;
  const Snapshot& seen = snapshot;
  EXPECT_EQ(seen.clock.step, before.state.clock.step);
  EXPECT_TRUE(same_bytes(seen.tools.column<ToolPose>(), before.state.tools.column<ToolPose>()));
  EXPECT_TRUE(same_bytes(seen.tools.column<ToolWrench>(), before.state.tools.column<ToolWrench>()));
  EXPECT_TRUE(
      same_bytes(seen.regions.column<RegionFrame>(), before.state.regions.column<RegionFrame>()));
  EXPECT_TRUE(
      same_bytes(seen.regions.column<RegionWrench>(), before.state.regions.column<RegionWrench>()));
  EXPECT_EQ(seen.region_fields.size(), before.state.regions.size());
  EXPECT_EQ(seen.anchors.size(), before.model.anchors.size());
}

// What only a picture needs is of one step: of another one nothing is left of it.
TEST(SnapshotTest, CaptureZeroesWhatIsFoundForPictures) {
  const World world = test::small_world(3);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  capture(world.model, world.state, snapshot);
  ASSERT_GT(snapshot.region_fields.size(), 0U);
  ASSERT_GT(snapshot.anchors.size(), 0U);
  snapshot.region_fields.at<RegionField>(0).radius = 1.0;
  snapshot.region_fields.at<AnchorTurns>(0).support = 1.0;
  snapshot.anchors.at<AnchorMotion>(0).displacement.x = 1.0;
  capture(world.model, world.state, snapshot);
  EXPECT_EQ(snapshot.region_fields.at<RegionField>(0).radius, 0.0);
  EXPECT_EQ(snapshot.region_fields.at<AnchorTurns>(0).support, 0.0);
  EXPECT_EQ(snapshot.anchors.at<AnchorMotion>(0).displacement.x, 0.0);
}

TEST(SnapshotTest, RegionsMayComeAndGoBetweenCapturesWithoutAllocating) {
  World world = test::small_world(2);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  const test::AllocationGuard guard;
  capture(world.model, world.state, snapshot);
  world.state.regions.append(2);
  capture(world.model, world.state, snapshot);
  EXPECT_EQ(snapshot.regions.size(), 4U);
  world.state.regions.clear();
  capture(world.model, world.state, snapshot);
  EXPECT_EQ(snapshot.regions.size(), 0U);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace torsion::engine
