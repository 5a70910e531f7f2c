// A knob that turns the tool which a gateway's client moves.

#include "device/joined_knob.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

DeviceSample client_at(double time) {
  DeviceSample sample;
  sample.state = DeviceState::kLive;
  sample.time = time;
  sample.number = 1;
  sample.epoch = 1;
  sample.sensed = kTranslationAxes | kRotationAxes;
  sample.actuated = kTranslationAxes;
  sample.traits.largest_force = 3.3;
  sample.traits.period = 1e-3;
  // Its own turn: a quarter about x, so that the tool's turn axis points along z.
  sample.pose.rotation = glm::angleAxis(std::acos(0.0), glm::dvec3(1.0, 0.0, 0.0));
  return sample;
}

DeviceSample knob_at(double time, double angle) {
  DeviceSample sample;
  sample.state = DeviceState::kLive;
  sample.time = time;
  sample.number = 1;
  sample.epoch = 1;
  sample.sensed = kTurnAxis;
  sample.actuated = kTurnAxis;
  sample.traits.largest_torque = 0.2;
  sample.traits.period = 1e-3;
  sample.traits.delay = 5e-4;
  sample.pose.rotation = glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
  return sample;
}

TEST(JoinedKnobTest, TurnsTheToolAboutItsOwnAxisAndGetsTheTorqueAboutIt) {
  JoinedKnob knob;
  EXPECT_EQ(take_knob_sample(knob, knob_at(1.0, 0.4)).torque, glm::dvec3(0.0));  // nobody asked
  DeviceSample whole = client_at(1.0005);
  join_knob(knob, whole);
  ASSERT_EQ(whole.state, DeviceState::kLive);
  EXPECT_EQ(whole.sensed, kTranslationAxes | kRotationAxes | kTurnAxis);
  EXPECT_EQ(whole.actuated, kTranslationAxes | kTurnAxis);
  EXPECT_EQ(whole.traits.largest_torque, 0.2);
  EXPECT_EQ(whole.traits.largest_force, 3.3);
  EXPECT_EQ(whole.traits.delay, 5e-4);
  const glm::dvec3 side = whole.pose.rotation * glm::dvec3(1.0, 0.0, 0.0);
  EXPECT_NEAR(side.x, std::cos(0.4), 1e-12);
  EXPECT_NEAR(side.y, std::sin(0.4), 1e-12);  // about the world's z, where its axis points
  ask_knob(knob, whole, {{1.0, 2.0, 3.0}, {0.5, 0.7, 0.08}});
  const Wrench shown = take_knob_sample(knob, knob_at(1.001, 0.4));
  EXPECT_NEAR(shown.torque.y, 0.08, 1e-12);
  EXPECT_EQ(shown.force, glm::dvec3(0.0));
}

TEST(JoinedKnobTest, NeitherDisplaysWhatTheOtherDoesNotStandFor) {
  JoinedKnob knob;
  DeviceSample whole = client_at(1.0);
  join_knob(knob, whole);  // no knob is there yet
  EXPECT_EQ(whole.state, DeviceState::kStarting);
  DeviceSample broken = knob_at(1.0, 0.0);
  broken.state = DeviceState::kStarting;
  broken.trouble = DeviceTrouble::kMotorError;
  broken.motor_errors = 5;
  take_knob_sample(knob, broken);
  whole = client_at(1.001);
  join_knob(knob, whole);
  EXPECT_EQ(whole.trouble, DeviceTrouble::kMotorError);
  EXPECT_EQ(whole.motor_errors, 5U);
  take_knob_sample(knob, knob_at(1.002, 0.0));
  whole = client_at(1.003);
  join_knob(knob, whole);
  ASSERT_EQ(whole.state, DeviceState::kLive);
  ask_knob(knob, whole, {glm::dvec3(0.0), {0.1, 0.1, 0.1}});
  EXPECT_GT(glm::length(take_knob_sample(knob, knob_at(1.0065, 0.0)).torque), 0.05);
  EXPECT_EQ(take_knob_sample(knob, knob_at(1.0075, 0.0)).torque, glm::dvec3(0.0));  // silent
  whole = client_at(1.04);
  join_knob(knob, whole);  // the knob fell silent
  EXPECT_EQ(whole.state, DeviceState::kStarting);
  // And what a client that is not live leaves is nothing.
  take_knob_sample(knob, knob_at(1.041, 0.0));
  whole = client_at(1.0415);
  whole.state = DeviceState::kStarting;
  join_knob(knob, whole);
  ask_knob(knob, whole, {glm::dvec3(0.0), {0.1, 0.1, 0.1}});
  EXPECT_EQ(take_knob_sample(knob, knob_at(1.042, 0.0)).torque, glm::dvec3(0.0));
}

TEST(JoinedKnobTest, AnotherOneOfEitherBeginsAnew) {
  JoinedKnob knob;
  take_knob_sample(knob, knob_at(1.0, 0.0));
  DeviceSample before = client_at(1.0);
  join_knob(knob, before);
  DeviceSample again = knob_at(1.001, 0.0);
  again.epoch = 2;
  again.plugged = 1;
  take_knob_sample(knob, again);
  DeviceSample after = client_at(1.001);
  join_knob(knob, after);
  EXPECT_NE(before.epoch, after.epoch);
  EXPECT_NE(before.plugged, after.plugged);
}

}  // namespace
}  // namespace torsion::engine
