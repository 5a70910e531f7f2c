#include "systems/hold/output_guard.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kPeriod;

GuardLimits limits() {
  GuardLimits limits;
  limits.largest_force = 8.0;
  limits.largest_torque = 0.2;
  limits.largest_force_rate = 4000.0;
  limits.largest_torque_rate = 100.0;
  limits.first_rise = limits.rise;
  return limits;
}

GuardInput wants(double force, double torque = 0.0) {
  GuardInput input;
  input.wanted = {{0.0, force, 0.0}, {0.0, torque, 0.0}};
  return input;
}

OutputGuard live(const GuardInput& input) {
  OutputGuard guard;
  for (int i = 0; i < 200; ++i) {
    guard_output(guard, limits(), input, kPeriod);
  }
  return guard;
}

TEST(OutputGuardTest, SendsWhatIsWantedOnceItHasRisen) {
  OutputGuard guard;
  double before = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double force = guard_output(guard, limits(), wants(4.0, 0.1), kPeriod).force.y;
    EXPECT_GE(force, before);
    EXPECT_LE(force - before, 4.0 * kPeriod / limits().rise + 1e-12);
    before = force;
  }
  EXPECT_EQ(guard.state, GuardState::kLive);
  EXPECT_EQ(guard.sent.force.y, 4.0);
  EXPECT_EQ(guard.sent.torque.y, 0.1);
}

TEST(OutputGuardTest, WaitsForTheHandle) {
  OutputGuard guard;
  GuardInput input = wants(4.0);
  input.distance = 0.05;
  for (int i = 0; i < 500; ++i) {
    EXPECT_EQ(guard_output(guard, limits(), input, kPeriod).force, glm::dvec3(0.0));
  }
  EXPECT_EQ(guard.state, GuardState::kWaiting);
}

TEST(OutputGuardTest, FallsToZeroWhenThePhysicsIsSilent) {
  const GuardInput input = wants(4.0, 0.1);
  OutputGuard guard = live(input);
  double before = guard.sent.force.y;
  for (int i = 1; i <= 13; ++i) {
    GuardInput silent = input;
    silent.result_age = i * kPeriod;
    const Wrench sent = guard_output(guard, limits(), silent, kPeriod);
    if (i <= 3) {
      EXPECT_EQ(sent.force.y, 4.0) << i;
    } else {
      EXPECT_LT(sent.force.y, before) << i;
      EXPECT_LE(before - sent.force.y, 4.0 * 0.1 + 1e-12) << i;  // a tenth of 10 ms
    }
    before = sent.force.y;
  }
  EXPECT_EQ(guard.sent.force, glm::dvec3(0.0));  // 3 ms and 10 ms
  EXPECT_EQ(guard.sent.torque, glm::dvec3(0.0));
}

TEST(OutputGuardTest, FallsAtAFaultAtOnceAndComesBackOnlyThroughWaiting) {
  const GuardInput input = wants(4.0);
  OutputGuard guard = live(input);
  GuardInput faulty = input;
  faulty.faulty = true;
  for (int i = 0; i < 10; ++i) {
    guard_output(guard, limits(), faulty, kPeriod);
  }
  EXPECT_EQ(guard.sent.force, glm::dvec3(0.0));
  GuardInput far = input;
  far.distance = 0.1;
  guard_output(guard, limits(), far, kPeriod);
  EXPECT_EQ(guard.state, GuardState::kWaiting);
  guard_output(guard, limits(), input, kPeriod);
  EXPECT_EQ(guard.state, GuardState::kRising);
}

TEST(OutputGuardTest, NeverSendsWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    OutputGuard guard = live(wants(4.0));
    for (int i = 0; i < 20; ++i) {
      const Wrench sent = guard_output(guard, limits(), wants(bad, bad), kPeriod);
      EXPECT_TRUE(std::isfinite(sent.force.y) && std::isfinite(sent.torque.y));
    }
    EXPECT_EQ(guard.sent.force, glm::dvec3(0.0));
  }
}

TEST(OutputGuardTest, KeepsToItsLimitsOfSizeAndRate) {
  OutputGuard guard = live(wants(0.0));
  double before = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double force = guard_output(guard, limits(), wants(100.0, 5.0), kPeriod).force.y;
    EXPECT_LE(force - before, 4.0 + 1e-12);  // 4000 N/s
    before = force;
  }
  EXPECT_NEAR(guard.sent.force.y, 8.0, 1e-12);
  EXPECT_NEAR(guard.sent.torque.y, 0.2, 1e-12);
}

TEST(OutputGuardTest, AFaultWhileItRisesFallsFromWhereItIs) {
  OutputGuard guard;
  for (int i = 0; i < 20; ++i) {
    guard_output(guard, limits(), wants(4.0), kPeriod);
  }
  ASSERT_EQ(guard.state, GuardState::kRising);
  const double reached = guard.sent.force.y;
  GuardInput faulty = wants(4.0);
  faulty.faulty = true;
  EXPECT_LT(guard_output(guard, limits(), faulty, kPeriod).force.y, reached);
  for (int i = 0; i < 10; ++i) {
    guard_output(guard, limits(), faulty, kPeriod);
  }
  EXPECT_EQ(guard.sent.force, glm::dvec3(0.0));
}

TEST(OutputGuardTest, RisesOverASecondTheFirstTimeAndQuicklyAfterwards) {
  GuardLimits slow = limits();
  slow.first_rise = 1.0;
  OutputGuard guard;
  double before = 0.0;
  for (int i = 0; i < 1100; ++i) {
    const double force = guard_output(guard, slow, wants(4.0), kPeriod).force.y;
    EXPECT_LE(force - before, 4.0 * kPeriod + 1e-12);
    before = force;
  }
  EXPECT_EQ(guard.sent.force.y, 4.0);
  GuardInput faulty = wants(4.0);
  faulty.faulty = true;
  for (int i = 0; i < 20; ++i) {
    guard_output(guard, slow, faulty, kPeriod);
  }
  EXPECT_EQ(guard.sent.force, glm::dvec3(0.0));
  for (int i = 0; i < 60; ++i) {
    guard_output(guard, slow, wants(4.0), kPeriod);
  }
  EXPECT_EQ(guard.sent.force.y, 4.0);
}

/// Any of what takes a force away. @return how many samples until there is none
int samples_to_fall(OutputGuard& guard, const GuardInput& input) {
  int samples = 0;
  for (; samples < 100 && guard.sent.force != glm::dvec3(0.0); ++samples) {
    guard_output(guard, limits(), input, kPeriod);
  }
  return samples;
}

TEST(OutputGuardTest, FallsWhenTheButtonIsLetGoAndWhenTheHandleIsTooFast) {
  GuardInput let_go = wants(4.0);
  let_go.held = false;
  GuardInput fast = wants(4.0);
  fast.velocity = {0.0, 0.0, 1.3};
  GuardInput spinning = wants(4.0);
  spinning.turn_speed = 41.0;
  for (const auto& [input, reason] :
       {std::pair(let_go, GuardReason::kLetGo), std::pair(fast, GuardReason::kTooFast),
        std::pair(spinning, GuardReason::kTooFast)}) {
    OutputGuard guard = live(wants(4.0));
    EXPECT_LE(samples_to_fall(guard, input), 11);  // 10 ms
    EXPECT_EQ(guard.reason, reason);
    guard_output(guard, limits(), input, kPeriod);
    EXPECT_EQ(guard.state, GuardState::kWaiting);
    for (int i = 0; i < 100; ++i) {  // nothing while it lasts
      EXPECT_EQ(guard_output(guard, limits(), input, kPeriod).force, glm::dvec3(0.0));
    }
    for (int i = 0; i < 100; ++i) {
      guard_output(guard, limits(), wants(4.0), kPeriod);
    }
    EXPECT_EQ(guard.sent.force.y, 4.0);
  }
}

TEST(OutputGuardTest, OneThatGoesTheOtherWayStaysOff) {
  OutputGuard guard;
  GuardInput input = wants(4.0);
  input.probe.force.y = 0.3;
  input.signs = SignVerdict::kRunning;
  for (int i = 0; i < 500; ++i) {
    EXPECT_LE(guard_output(guard, limits(), input, kPeriod).force.y, 0.3);
  }
  ASSERT_EQ(guard.state, GuardState::kChecking);
  EXPECT_EQ(guard.sent.force.y, 0.3);
  input.signs = SignVerdict::kReversed;
  EXPECT_LE(samples_to_fall(guard, input), 11);
  for (int i = 0; i < 1000; ++i) {
    guard_output(guard, limits(), wants(4.0), kPeriod);
  }
  EXPECT_EQ(guard.state, GuardState::kOff);
  EXPECT_EQ(guard.reason, GuardReason::kReversed);
  EXPECT_EQ(guard.sent.force, glm::dvec3(0.0));
}

/// More than the limit, and faster, where what carries the device is counted in?
void expect_within(const Wrench& sent, const Wrench& before) {
  EXPECT_LE(glm::length(sent.force), limits().largest_force + 1e-12);
  EXPECT_LE(glm::length(sent.force - before.force), limits().largest_force_rate * kPeriod + 1e-12);
}

TEST(OutputGuardTest, WhatCarriesTheDeviceComesAndGoesWithItsForceAndWithinItsLimits) {
  GuardInput input = wants(3.0, 0.1);
  input.weight.y = 1.5;
  input.distance = 0.05;
  OutputGuard guard;
  EXPECT_EQ(guard_output(guard, limits(), input, kPeriod).force, glm::dvec3(0.0));
  input.distance = 0.0;
  Wrench before;
  for (int i = 0; i < 200; ++i) {
    const Wrench sent = guard_output(guard, limits(), input, kPeriod);
    EXPECT_NEAR(sent.force.y, guard.share * 4.5, 1e-12);
    expect_within(sent, before);
    before = sent;
  }
  EXPECT_EQ(guard.sent.force.y, 3.0);  // what the person feels of the tool
  EXPECT_EQ(guard.carried.y, 1.5);
  // One of 5 N, the other 6: no more than 8 together, and the arm is carried.
  for (const double force : {6.0, -8.0, 8.0}) {
    for (const double weight : {5.0, 0.0, 1.5}) {
      input.wanted.force = {0.3 * force, force, 0.0};
      input.weight.y = weight;
      for (int i = 0; i < 10; ++i) {
        const Wrench sent = guard_output(guard, limits(), input, kPeriod);
        expect_within(sent, before);
        before = sent;
      }
      EXPECT_EQ(guard.carried.y, weight);
    }
  }
  input.live = false;
  EXPECT_LE(samples_to_fall(guard, input), 11);
  EXPECT_EQ(guard.carried, glm::dvec3(0.0));
  input.live = true;
  input.weight.y = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(guard_output(guard, limits(), input, kPeriod).force, glm::dvec3(0.0));
  }
}

TEST(OutputGuardTest, WhatCarriesTheDeviceWarmsItsMotors) {
  GuardInput input = wants(0.0);
  input.weight.y = 1.5;
  OutputGuard guard;
  guard.force_heat.continuous = 4.0;
  for (int i = 0; i < 100'000; ++i) {
    guard_output(guard, limits(), input, kPeriod);
  }
  EXPECT_NEAR(guard.force_heat.loss, 1.5 * 1.5, 1e-3);
}

TEST(OutputGuardTest, OneOfUnknownSignsThatRunsAgainstTheForceIsTurnedOff) {
  for (const SignVerdict signs : {SignVerdict::kUnresolved, SignVerdict::kRight}) {
    GuardLimits slow = limits();
    slow.first_rise = 1.0;
    OutputGuard guard;
    GuardInput input = wants(4.0);
    input.signs = signs;
    for (int i = 0; i < 300; ++i) {
      guard_output(guard, slow, input, kPeriod);
    }
    ASSERT_EQ(guard.state, GuardState::kRising);
    input.velocity = {0.0, -0.4, 0.0};
    for (int i = 0; i < 20; ++i) {  // as one wrong packet may look
      guard_output(guard, slow, input, kPeriod);
    }
    ASSERT_EQ(guard.state, GuardState::kRising);
    for (int i = 0; i < 30; ++i) {
      guard_output(guard, slow, input, kPeriod);
    }
    // A hand that pushes may well be as fast, where it is known that the device is right.
    EXPECT_EQ(guard.state, signs == SignVerdict::kRight ? GuardState::kRising : GuardState::kOff);
  }
}

}  // namespace
}  // namespace torsion::engine
