// Whether a device goes where it is pushed: emulated hands from loose to stiff, with every sign
// right and wrong.

#include "systems/hold/sign_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "ecs/device_sample.hpp"
#include "systems/hold/handle_side.hpp"
#include "tests/support/studies.hpp"
#include "tests/systems/hold/emulated_hand.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedHand;
using test::HandTraits;

constexpr std::uint8_t kAll = kTranslationAxes | kRotationAxes;

/// A person who holds still, or sways by `sway` [m] once a second.
struct Person {
  HandTraits hand;
  double period = 1e-3;  // s
  double sway = 0.0;     // m
  std::uint32_t seed = 1;
};

/// The verdict on a device that displays a twentieth of its largest wrench.
SignVerdict verdict(const Person& person, std::uint8_t axes, SignCheck* left = nullptr) {
  EmulatedHand hand(person.hand, {}, person.seed);
  SignCheck check;
  const DeviceTraits device = test::device_of(person.hand, person.period);
  begin_sign_check(check, axes,
                   {0.05 * person.hand.largest_force, 0.05 * person.hand.largest_torque},
                   glm::dquat(1.0, 0.0, 0.0, 0.0), device.delay);
  SignVerdict now = SignVerdict::kRunning;
  for (int i = 0; now == SignVerdict::kRunning; ++i) {
    EXPECT_LT(i * person.period, 9.0) << "it has to come to an end";
    now = take_sign_sample(check, hand.measured(), person.period);
    const double phase = 2.0 * std::numbers::pi * i * person.period;
    Pose wanted;
    wanted.position = person.sway * glm::dvec3(std::sin(phase), std::cos(0.7 * phase), 0.3);
    hand.move(sign_probe(check), wanted, person.period);
  }
  if (left != nullptr) {
    *left = check;
  }
  return now;
}

Person random_person(std::mt19937& random) {
  Person person;
  person.hand = test::random_hand(random);
  person.sway = std::uniform_real_distribution<double>(0.0, 5e-3)(random);
  person.seed = static_cast<std::uint32_t>(random());
  return person;
}

TEST(SignCheckTest, FindsEveryGripRightAtEveryRate) {
  for (const double rate : {100.0, 1000.0, 4000.0}) {
    for (const double grip : {50.0, 200.0, 1000.0}) {
      Person person;
      person.period = 1.0 / rate;
      person.hand.grip_stiffness = grip;
      person.hand.encoder_step = 6.4e-5;  // m: a Falcon's
      person.hand.encoder_turn_step = 7.7e-4;
      SCOPED_TRACE(testing::Message() << rate << " Hz, grip " << grip);
      EXPECT_EQ(verdict(person, kAll), SignVerdict::kRight);
    }
  }
}

TEST(SignCheckTest, FindsEachReversedMotorAndEncoder) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double grip : {50.0, 1000.0}) {
      Person motor;
      motor.hand.grip_stiffness = grip;
      Person encoder = motor;
      motor.hand.motors[axis][axis] = -1.0;
      encoder.hand.encoders[axis] = -1.0;
      SignCheck left;
      EXPECT_EQ(verdict(motor, kAll, &left), SignVerdict::kReversed) << axis;
      EXPECT_EQ(left.reversed, 1U << static_cast<unsigned>(axis));
      EXPECT_EQ(verdict(encoder, kAll, &left), SignVerdict::kReversed) << axis;
      EXPECT_EQ(left.reversed, 1U << static_cast<unsigned>(axis));
    }
  }
}

TEST(SignCheckTest, FindsAReversedKnob) {
  Person person;
  EXPECT_EQ(verdict(person, kTurnAxis), SignVerdict::kRight);
  person.hand.turn_motor = -1.0;
  SignCheck left;
  EXPECT_EQ(verdict(person, kTurnAxis, &left), SignVerdict::kReversed);
  EXPECT_EQ(left.reversed, 1U << 4U);
  // Beside a device that translates and is right.
  EXPECT_EQ(verdict(person, kTranslationAxes | kTurnAxis), SignVerdict::kReversed);
}

/// With one motor of a mechanism's three reversed the force is turned over along that leg, so that
/// no world axis has to show it.
glm::dmat3 reversed_along(const glm::dvec3& leg) {
  const glm::dvec3 along = glm::normalize(leg);
  return glm::dmat3(1.0) - 2.0 * glm::outerProduct(along, along);
}

TEST(SignCheckTest, FindsOneReversedMotorOfThreeThatActTogether) {
  for (int leg = 0; leg < 3; ++leg) {  // a third of a turn apart
    const double angle = 2.0 * std::numbers::pi * leg / 3.0;
    Person person;
    person.hand.motors = reversed_along(
        {std::numbers::sqrt2 * std::cos(angle), 1.0, std::numbers::sqrt2 * std::sin(angle)});
    SignCheck left;
    EXPECT_EQ(verdict(person, kTranslationAxes, &left), SignVerdict::kReversed) << leg;
  }
}

// Every axis goes the right way by itself, and to a hand that is all spring at these frequencies
// the mobility says nothing.
TEST(SignCheckTest, FindsOneReversedMotorOfThreeInAHandOfSprings) {
  for (const double damping : {2.0, 4.0, 8.0}) {
    Person person;
    person.hand.mass = 0.05;
    person.hand.grip_stiffness = 1500.0;
    person.hand.grip_damping = damping;
    EXPECT_NE(verdict(person, kTranslationAxes), SignVerdict::kReversed) << damping;
    person.hand.motors = reversed_along({1.0, 1.0, 1.0});
    EXPECT_NE(verdict(person, kTranslationAxes), SignVerdict::kRight) << damping;
  }
}

TEST(SignCheckTest, SaysThatItSawNothingWhereNothingMoves) {
  for (const double stiffness : {1e5, 1e7}) {  // a vice
    Person person;
    person.hand.grip_stiffness = stiffness;
    person.hand.grip_damping = 0.1 * std::sqrt(stiffness);
    person.hand.grip_turn_stiffness = 1e-4 * stiffness;
    person.hand.encoder_step = 6.4e-5;
    person.hand.encoder_turn_step = 7.7e-4;
    EXPECT_EQ(verdict(person, kAll), SignVerdict::kUnresolved) << stiffness;
  }
  EXPECT_EQ(verdict({}, kNoAxes), SignVerdict::kRight);  // nothing to check
}

TEST(SignCheckTest, IsNeverWrongWhoeverHoldsIt) {
  std::mt19937 random(7);
  std::mt19937 legs(8);
  int unresolved = 0;
  int missed = 0;
  const int hands = test::trials_of(200);
  for (int i = 0; i < hands; ++i) {
    Person person = random_person(random);
    const SignVerdict right = verdict(person, kTranslationAxes | kTurnAxis);
    EXPECT_NE(right, SignVerdict::kReversed) << i;
    unresolved += right == SignVerdict::kUnresolved ? 1 : 0;
    const int axis = i % 4;
    axis < 3 ? person.hand.motors[axis][axis] = -1.0 : person.hand.turn_motor = -1.0;
    const SignVerdict wrong = verdict(person, kTranslationAxes | kTurnAxis);
    EXPECT_NE(wrong, SignVerdict::kRight) << i;
    missed += wrong == SignVerdict::kUnresolved ? 1 : 0;
    std::normal_distribution<double> normal;
    const double x = normal(legs);
    const double y = normal(legs);
    person.hand.turn_motor = 1.0;
    person.hand.motors = reversed_along({x, y, normal(legs)});
    EXPECT_NE(verdict(person, kTranslationAxes), SignVerdict::kRight) << i;
  }
  RecordProperty("unresolved", unresolved);
  RecordProperty("missed", missed);
  // Nine in ten of hands so different have to be seen for the check to be of use.
  EXPECT_LT(unresolved, hands / 10);
  EXPECT_LT(missed, hands / 10);
}

/// A device and its person before a tool that is held where it is, from the first sample on.
struct Session {
  HandleSide side;
  double most_force = 0.0;  // N, displayed
  double most_speed = 0.0;  // m/s, of the handle
  double farthest = 0.0;    // m, likewise
  double work = 0.0;        // J, of the motors on the hand
  HandleOutcome last;
};

/// `seconds` with a person who pushes 4 mm down after a second.
/// @param fault_at  s: when the physics has a fault for 20 ms; never where it is negative
Session session(const Person& person, double seconds, double fault_at = -1.0) {
  Session outcome;
  EmulatedHand hand(person.hand, {}, person.seed);
  DeviceSample sample;
  sample.state = DeviceState::kLive;
  sample.epoch = 1;
  sample.sensed = kAll;
  sample.actuated = kAll;
  sample.traits = test::device_of(person.hand, person.period);
  PhysicsResult physics;
  physics.any = true;
  for (int i = 0; i * person.period < seconds; ++i) {
    const double now = 10.0 + i * person.period;
    sample.pose = hand.measured();
    physics.time = now;
    const double since_fault = i * person.period - fault_at;
    physics.faulty = fault_at >= 0.0 && since_fault >= 0.0 && since_fault < 0.02;
    outcome.last = take_handle_sample(outcome.side, sample, physics, now);
    Pose wanted;
    wanted.position.y = -4e-3 * std::clamp(i * person.period - 1.0, 0.0, 1.0);
    hand.move(outcome.last.wrench, wanted, person.period);
    outcome.most_force = std::max(outcome.most_force, glm::length(outcome.last.wrench.force));
    outcome.most_speed = std::max(outcome.most_speed, glm::length(hand.state().velocity));
    outcome.farthest = std::max(outcome.farthest, glm::length(hand.state().pose.position));
  }
  outcome.work = hand.motor_work();
  return outcome;
}

TEST(SignCheckTest, AReversedDeviceNeverGetsMoreThanATwentiethAndStaysOff) {
  for (const double grip : {50.0, 200.0, 1000.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      Person person;
      person.hand.grip_stiffness = grip;
      person.hand.motors[axis][axis] = -1.0;
      const Session seen = session(person, 8.0);
      SCOPED_TRACE(testing::Message() << "grip " << grip << ", axis " << axis);
      EXPECT_EQ(seen.side.guard.state, GuardState::kOff);
      EXPECT_EQ(seen.side.guard.reason, GuardReason::kReversed);
      EXPECT_EQ(seen.side.signs.reversed, 1U << static_cast<unsigned>(axis));
      EXPECT_EQ(seen.last.wrench.force, glm::dvec3(0.0));
      EXPECT_LE(seen.most_force, 0.05 * person.hand.largest_force + 1e-9);
      // The probe's force alone moves the loosest of these by F / (c w) at its lowest frequency.
      EXPECT_LT(seen.farthest, 4e-3 + 0.5 / (6.0 * 2.0 * std::numbers::pi * 8.0));
    }
  }
}

TEST(SignCheckTest, ARightDeviceGetsItsForceWithinASecondAfterTheCheck) {
  for (const double grip : {200.0, 1000.0}) {
    Person person;
    person.hand.grip_stiffness = grip;
    const Session seen = session(person, 5.0);  // two checks of 1.1 s, a second to rise
    EXPECT_EQ(seen.side.guard.state, GuardState::kLive) << grip;
    EXPECT_EQ(seen.side.guard.signs, SignVerdict::kRight) << grip;
    // At rest the spring of the coupling and that of the grip share the 4 mm.
    const double stiffness = seen.side.coupling.stiffness;
    const double force = 4e-3 * stiffness * grip / (stiffness + grip);
    EXPECT_NEAR(seen.last.wrench.force.y, force, 0.05 * force) << grip;
  }
}

TEST(SignCheckTest, GoesOnAfterAnInterruptionWithWhatItHasNotSeen) {
  // The translation is seen after 1.1 s: only the turning begins anew, and all is there 1.62 s, 1.1
  // s and 1 s after the beginning; all of it anew would take 1.1 s more.
  const Session seen = session({}, 4.0, 1.6);
  EXPECT_EQ(seen.side.guard.signs, SignVerdict::kRight);
  EXPECT_EQ(seen.side.guard.state, GuardState::kLive);
}

TEST(SignCheckTest, IsDoneOnceForEachDeviceAndAnOffOneStaysOffAfterASilence) {
  for (const bool reversed : {false, true}) {
    Person person;
    person.hand.motors[1][1] = reversed ? -1.0 : 1.0;
    Session seen = session(person, 5.0);
    const GuardState before = seen.side.guard.state;
    ASSERT_EQ(before, reversed ? GuardState::kOff : GuardState::kLive);
    DeviceSample sample;
    sample.sensed = kAll;
    sample.actuated = kAll;
    sample.traits = test::device_of(person.hand, person.period);
    sample.pose = seen.side.speed.measured;
    PhysicsResult physics;
    physics.any = true;
    double now = 20.0;
    const auto run = [&](DeviceState state, std::uint32_t epoch, std::uint32_t plugged) {
      sample.state = state;
      sample.epoch = epoch;
      sample.plugged = plugged;
      for (int i = 0; i < 100; ++i) {
        now += person.period;
        physics.time = now;
        take_handle_sample(seen.side, sample, physics, now);
      }
      return seen.side.guard.state;
    };
    run(DeviceState::kStarting, 1, 0);
    EXPECT_EQ(run(DeviceState::kLive, 2, 0), before);
    run(DeviceState::kAbsent, 2, 0);
    EXPECT_EQ(run(DeviceState::kLive, 3, 1), GuardState::kChecking);  // another one
  }
}

}  // namespace
}  // namespace torsion::engine
