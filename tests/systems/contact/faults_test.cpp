#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "ecs/hash.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;
using test::kUpright;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Hand pressed() {
  Hand hand(test::ball_on_cube());
  hand.step_to({{glm::dvec3(0.0, 0.1501, 0.0), kUpright}});
  hand.move({0.0, -5e-4, 0.0}, kUp, 0.0, 100);
  hand.move(glm::dvec3(0.0), kUp, 0.2, 100);
  return hand;
}

bool finite(const Wrench& wrench) {
  const glm::dvec3 sum = wrench.force + wrench.torque;
  return std::isfinite(sum.x + sum.y + sum.z);
}

TEST(FaultsTest, ANaNPoseFadesTheForceToZeroAndBack) {
  Hand hand = pressed();
  const Pose good = hand.poses[0];
  const double force = hand.wrench().force.y;
  ASSERT_GT(force, 1.0);
  double before = force;
  for (int i = 0; i < 20; ++i) {
    hand.step_to({{glm::dvec3(kNaN, 0.15, 0.0), kUpright}});
    EXPECT_TRUE(raised(hand.clock().faults, Fault::kPoseNotFinite));
    EXPECT_TRUE(finite(hand.wrench()));
    // 10 ms at 1 kHz: a tenth a step, never a jump.
    EXPECT_LE(std::abs(hand.wrench().force.y - before), 0.101 * force);
    before = hand.wrench().force.y;
  }
  EXPECT_EQ(hand.wrench().force, glm::dvec3(0.0));
  for (int i = 0; i < 100; ++i) {
    hand.step_to({good});
    EXPECT_LE(std::abs(hand.wrench().force.y - before), 0.101 * force);
    before = hand.wrench().force.y;
  }
  EXPECT_NEAR(hand.wrench().force.y, force, 1e-6 * force);
  EXPECT_EQ(hand.clock().faults, 0U);
  EXPECT_TRUE(raised(hand.clock().faults_ever, Fault::kPoseNotFinite));
}

TEST(FaultsTest, ABadQuaternionIsAFault) {
  Hand hand = pressed();
  hand.step_to({{hand.poses[0].position, glm::dquat(0.0, 0.0, 0.0, 0.0)}});
  EXPECT_TRUE(raised(hand.clock().faults, Fault::kPoseNotFinite));
  EXPECT_TRUE(finite(hand.wrench()));
}

TEST(FaultsTest, ATeleportIntoTheMiddleOfTheBodyIsBounded) {
  Hand hand = pressed();
  const double force = hand.wrench().force.y;
  double largest = 0.0;
  for (int i = 0; i < 100; ++i) {
    hand.step_to({{glm::dvec3(0.0, 0.05, 0.0), kUpright}});
    EXPECT_TRUE(finite(hand.wrench()));
    largest = std::max(largest, glm::length(hand.wrench().force));
    if (i == 0) {
      EXPECT_TRUE(raised(hand.clock().faults, Fault::kPoseJumped));
    }
    EXPECT_TRUE(raised(hand.clock().faults, Fault::kTooDeep)) << i;
  }
  EXPECT_LE(largest, force);
  EXPECT_EQ(hand.wrench().force, glm::dvec3(0.0));
}

TEST(FaultsTest, PressedThroughTheWholeBodyIsBounded) {
  Hand hand = pressed();
  bool deep = false;
  double largest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    hand.move({0.0, -1e-4, 0.0}, kUp, 0.0, 1);
    EXPECT_TRUE(finite(hand.wrench()));
    deep = deep || raised(hand.clock().faults, Fault::kTooDeep);
    largest = std::max(largest, glm::length(hand.wrench().force));
  }
  EXPECT_TRUE(deep);
  // E times the cube's face: what squeezing it flat would take.
  EXPECT_LT(largest, 3e6 * 0.01);
}

TEST(FaultsTest, AThousandTurnsInASecondIsAFault) {
  Hand hand = pressed();
  const Pose start = hand.poses[0];
  for (int i = 0; i < 1000; ++i) {
    hand.step_to({{start.position, glm::angleAxis(6.283185307 * 1000.0 * i / 1000.3, kUp)}});
    EXPECT_TRUE(finite(hand.wrench()));
  }
  Hand fast = pressed();
  fast.step_to({{start.position, glm::angleAxis(2.5, kUp) * start.rotation}});
  EXPECT_TRUE(raised(fast.clock().faults, Fault::kPoseJumped));
}

TEST(FaultsTest, AThousandSlowTurnsStayWithinFriction) {
  Hand hand = pressed();
  double largest = 0.0;
  for (int i = 0; i < 63000; ++i) {
    hand.step_to({{hand.poses[0].position, glm::angleAxis(0.2 + 0.1 * i, kUp)}});
    largest = std::max(largest, std::abs(hand.wrench().torque.y));
  }
  EXPECT_EQ(hand.clock().faults_ever, 0U);
  const Contact& contact = hand.world().state.regions.at<Contact>(0);
  EXPECT_LT(largest, 1.02 * 2.0 / 3.0 * 0.75 * hand.wrench().force.y * contact.radius);
  // phi counts turns; a quaternion could not.
  EXPECT_NEAR(hand.world().state.regions.at<RegionMotion>(0).turn, 0.2 + 6299.9, 1e-3);
}

TEST(FaultsTest, EveryFaultSaysWhatToDo) {
  for (const Fault fault : kAllFaults) {
    EXPECT_NE(fault_text(fault), "unknown fault");
    EXPECT_NE(fault_text(fault).find(';'), std::string_view::npos);
  }
}

TEST(DeterminismTest, TwoRunsGiveTheSameBits) {
  EXPECT_EQ(hash(pressed().world()), hash(pressed().world()));
}

}  // namespace
}  // namespace torsion::engine
