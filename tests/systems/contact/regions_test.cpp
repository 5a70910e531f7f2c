#include <algorithm>

#include <gtest/gtest.h>

#include "systems/contact/region_wrenches.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;
using test::kUpright;

/// A slab whose top is y = 0.
BodyDescription slab() {
  return test::make_body({test::make_part(ShapeKind::kBox, {0.15, 0.05, 0.15},
                                          {glm::dvec3(0.0, -0.05, 0.0), kUpright})});
}

/// Small balls at the given places, the lowest point of each at the given y.
ToolDescription feet(const std::vector<glm::dvec3>& places, double radius = 0.006) {
  std::vector<PartDescription> parts;
  for (const glm::dvec3& place : places) {
    parts.push_back(test::make_part(ShapeKind::kSphere, glm::dvec3(radius),
                                    {place + glm::dvec3(0.0, radius, 0.0), kUpright}, false, 6));
  }
  return test::make_tool(std::move(parts));
}

SceneDescription scene_of(std::vector<BodyDescription> bodies, std::vector<ToolDescription> tools) {
  SceneDescription scene;
  scene.bodies = std::move(bodies);
  scene.tools = std::move(tools);
  return scene;
}

std::vector<std::uint64_t> orders(const World& world) {
  std::vector<std::uint64_t> result;
  for (const RegionIdentity& region : world.state.regions.column<RegionIdentity>()) {
    result.push_back(region.order);
  }
  return result;
}

TEST(RegionsTest, TenFeetThatTouchOneAfterAnotherKeepTheirOrder) {
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 10; ++i) {
    const double angle =
        0.6283185307179586 * (i * 3 % 10);  // neighbours in time are not neighbours in space
    places.emplace_back(0.06 * std::cos(angle), 1e-4 * i, 0.06 * std::sin(angle));
  }
  Hand hand(scene_of({slab()}, {feet(places)}));
  hand.step_to({{glm::dvec3(0.0, 1e-4, 0.0), kUpright}});
  hand.move({0.0, -1.5e-3, 0.0}, kUp, 0.0, 600);
  ASSERT_EQ(hand.world().state.regions.size(), 10U);
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(i).order, i);
    const glm::dvec3& point = hand.world().state.regions.at<Contact>(i).equivalent_point;
    EXPECT_NEAR(point.x, places[i].x, 1e-4);
    EXPECT_NEAR(point.z, places[i].z, 1e-4);
  }
  // Twisting about the vertical keeps all ten and their order.
  hand.move(glm::dvec3(0.0), kUp, 0.3, 300);
  EXPECT_EQ(orders(hand.world()), (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  // Lifting lets them go in the opposite order: the last formed first.
  hand.move({0.0, 0.55e-3, 0.0}, kUp, 0.0, 200);
  EXPECT_EQ(orders(hand.world()), (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(RegionsTest, AFootIsSeenWhenItTouchesNotWhenASampleDoes) {
  Hand hand(scene_of({slab()}, {feet({{0.0123, 0.0, 0.0045}})}));
  hand.step_to({{glm::dvec3(0.0, 1e-6, 0.0), kUpright}});
  EXPECT_EQ(hand.world().state.regions.size(), 0U);
  hand.move({0.0, -2e-6, 0.0}, kUp, 0.0, 1);
  // One micrometre deep: sixty times less than the height of the ball between two samples.
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  EXPECT_NEAR(hand.world().state.regions.at<Overlap>(0).largest_depth, 1e-6, 0.1e-6);
}

TEST(RegionsTest, ARegionThatEndedIsNotTheNextOneThere) {
  Hand hand(scene_of({slab()}, {feet({{0.0, 0.0, 0.0}})}));
  hand.step_to({{glm::dvec3(0.0, 1e-4, 0.0), kUpright}});
  hand.move({0.0, -3e-4, 0.0}, kUp, 0.0, 30);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(0).order, 0U);
  hand.move({0.0, 3e-4, 0.0}, kUp, 0.0, 30);
  ASSERT_EQ(hand.world().state.regions.size(), 0U);
  hand.move({0.0, -3e-4, 0.0}, kUp, 0.0, 30);
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(0).order, 1U);
}

TEST(RegionsTest, RegionsThatMergeKeepTheOldest) {
  // Two balls that overlap above their bottoms: pressed deep enough, the two discs meet.
  // set below their gap.
  SceneDescription scene =
      scene_of({slab()}, {feet({{-0.008, 0.0, 0.0}, {0.008, 2e-5, 0.0}}, 0.02)});
  Hand hand(scene);
  hand.step_to({{glm::dvec3(0.0, 1e-4, 0.0), kUpright}});
  hand.move({0.0, -5e-4, 0.0}, kUp, 0.0, 100);
  ASSERT_EQ(orders(hand.world()), (std::vector<std::uint64_t>{0, 1}));
  hand.move({0.0, -2e-3, 0.0}, kUp, 0.0, 400);
  EXPECT_EQ(orders(hand.world()), (std::vector<std::uint64_t>{0}));
  hand.move({0.0, 2e-3, 0.0}, kUp, 0.0, 400);
  // Split again: the larger part keeps the history, the other is new.
  ASSERT_EQ(hand.world().state.regions.size(), 2U);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(0).order, 0U);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(1).order, 2U);
}

TEST(RegionsTest, TwoBodiesUnderOneToolHaveRegionsOfTheirOwn) {
  BodyDescription left = slab();
  BodyDescription right = slab();
  left.pose.position = {-0.2, 0.0, 0.0};
  right.pose.position = {0.2, 0.0, 0.0};
  Hand hand(scene_of({left, right}, {feet({{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}})}));
  hand.step_to({{glm::dvec3(0.0, 1e-4, 0.0), kUpright}});
  hand.move({0.0, -4e-4, 0.0}, kUp, 0.0, 40);
  ASSERT_EQ(hand.world().state.regions.size(), 2U);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(0).body, 0U);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(1).body, 1U);
  // Mirror images but for where the samples lie and so the grids: 0.5 % is the error of 16 x 16
  // cells.
  EXPECT_NEAR(hand.world().state.regions.at<RegionNormal>(0).force,
              hand.world().state.regions.at<RegionNormal>(1).force,
              0.005 * hand.world().state.regions.at<RegionNormal>(1).force);
}

TEST(RegionsTest, TwoToolsOnOneBodyFeelTheirOwnForces) {
  Hand hand(scene_of({slab()}, {feet({{0.0, 0.0, 0.0}}), feet({{0.0, 0.0, 0.0}}, 0.012)}));
  hand.step_to(
      {{glm::dvec3(-0.05, 1e-4, 0.0), kUpright}, {glm::dvec3(0.05, -2e-4, 0.0), kUpright}});
  EXPECT_NEAR(hand.wrench(0).force.y, 0.0, 1e-12);
  for (int i = 0; i < 30; ++i) {
    hand.step_to({hand.poses[0], hand.poses[1]});
  }
  EXPECT_GT(hand.wrench(1).force.y, 0.1);
  ASSERT_EQ(hand.world().state.regions.size(), 1U);
  EXPECT_EQ(hand.world().state.regions.at<RegionIdentity>(0).tool, 1U);
}

TEST(RegionsTest, MoreThanSixteenRegionsRaiseAFaultAndTheStepEnds) {
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 18; ++i) {
    places.emplace_back(0.04 * (i % 6) - 0.1, 0.0, 0.04 * (i / 6) - 0.04);
  }
  Hand hand(scene_of({slab()}, {feet(places)}));
  hand.step_to({{glm::dvec3(0.0, 1e-4, 0.0), kUpright}});
  hand.move({0.0, -3e-4, 0.0}, kUp, 0.0, 30);
  EXPECT_EQ(hand.world().state.regions.size(), kMaxRegionsPerBody);
  EXPECT_TRUE(raised(hand.clock().faults, Fault::kRegionsFull));
}

TEST(RegionsTest, AStepAllocatesNothing) {
  Hand hand(scene_of({slab()}, {feet({{-0.03, 0.0, 0.0}, {0.03, 1e-4, 0.0}})}));
  const auto press_twist_lift = [&hand] {
    std::vector<Pose> pose(1);
    for (int i = 0; i < 300; ++i) {
      const double t = i / 300.0;
      pose[0].position = {0.0, 2e-4 - 6e-4 * std::sin(3.14159 * t), 0.0};
      pose[0].rotation = glm::angleAxis(0.5 * std::sin(6.28318 * t), kUp);
      torsion::engine::step(hand.simulation(), pose);
    }
  };
  const test::AllocationGuard guard;
  std::vector<Pose> pose(1, Pose{glm::dvec3(0.0, 2e-4, 0.0), kUpright});
  const std::uint64_t of_the_test = guard.allocations();
  torsion::engine::step(hand.simulation(), pose);
  EXPECT_EQ(guard.allocations(), of_the_test);
  press_twist_lift();
  // One vector of the lambda; the 301 steps, with regions that begin and end, took nothing.
  EXPECT_EQ(guard.allocations(), of_the_test + 1);
}

}  // namespace
}  // namespace torsion::engine
