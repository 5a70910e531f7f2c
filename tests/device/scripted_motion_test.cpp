#include "device/scripted_motion.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using test::kUp;

KeyedChannel steps_of_two(Interpolation interpolation) {
  return {interpolation,
          {1.0, 2.0, 4.0},
          {glm::dvec4(0.0), glm::dvec4(2.0, 0.0, 0.0, 0.0), glm::dvec4(2.0, 4.0, 0.0, 0.0)}};
}

glm::dvec4 xyzw(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}

TEST(ScriptedMotionTest, HoldsTheFirstAndTheLastValueOutsideTheKeys) {
  const KeyedChannel channel = steps_of_two(Interpolation::kLinear);
  EXPECT_EQ(translation_at(channel, 0.0), glm::dvec3(0.0));
  EXPECT_EQ(translation_at(channel, 9.0), glm::dvec3(2.0, 4.0, 0.0));
}

TEST(ScriptedMotionTest, LinearGoesStraight) {
  const KeyedChannel channel = steps_of_two(Interpolation::kLinear);
  EXPECT_EQ(translation_at(channel, 1.5), glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(translation_at(channel, 3.5), glm::dvec3(2.0, 3.0, 0.0));
}

TEST(ScriptedMotionTest, StepHoldsTheKeyBefore) {
  const KeyedChannel channel = steps_of_two(Interpolation::kStep);
  EXPECT_EQ(translation_at(channel, 1.999), glm::dvec3(0.0));
  EXPECT_EQ(translation_at(channel, 2.0), glm::dvec3(2.0, 0.0, 0.0));
}

/// A cubic whose tangents are its derivative is met exactly by Hermite's form.
TEST(ScriptedMotionTest, CubicSplineIsExactForACubic) {
  const auto value = [](double t) {
    return glm::dvec4(t * t * t - 2.0 * t, t * t, 3.0, 0.0);
  };
  const auto slope = [](double t) {
    return glm::dvec4(3.0 * t * t - 2.0, 2.0 * t, 0.0, 0.0);
  };
  KeyedChannel channel;
  channel.interpolation = Interpolation::kCubicSpline;
  channel.times = {0.5, 2.0, 2.5};
  for (const double time : channel.times) {
    channel.values.push_back(slope(time));
    channel.values.push_back(value(time));
    channel.values.push_back(slope(time));
  }
  for (const double time : {0.5, 0.7, 1.3, 1.999, 2.2, 2.5}) {
    EXPECT_LT(glm::distance(translation_at(channel, time), glm::dvec3(value(time))), 1e-12);
  }
}

TEST(ScriptedMotionTest, RotationTurnsEvenlyTheShorterWay) {
  const double angle = 1.2;  // rad
  // The second key is given as the opposite quaternion, which is the same rotation.
  const KeyedChannel channel{Interpolation::kLinear,
                             {0.0, 1.0},
                             {xyzw(glm::angleAxis(0.0, kUp)), -xyzw(glm::angleAxis(angle, kUp))}};
  for (const double time : {0.0, 0.25, 0.6, 1.0}) {
    const glm::dquat expected = glm::angleAxis(angle * time, kUp);
    EXPECT_NEAR(std::abs(glm::dot(rotation_at(channel, time), expected)), 1.0, 1e-14);
  }
}

TEST(ScriptedMotionTest, PoseIsTheProductOfTheLinksWithoutTheirScale) {
  MotionScript script;
  MotionLink parent;
  parent.translation = {1.0, 0.0, 0.0};
  parent.rotation = glm::angleAxis(0.5 * std::numbers::pi, kUp);  // x becomes -z
  parent.scale = glm::dvec3(2.0);
  MotionLink child;
  child.animated_translation = {
      Interpolation::kLinear, {0.0, 1.0}, {glm::dvec4(0.0), glm::dvec4(3.0, 0.0, 0.0, 0.0)}};
  script.links = {parent, child};
  const Pose pose = scripted_pose(script, 1.0);
  // The parent's scale stretches the child's way, not the child itself.
  EXPECT_LT(glm::distance(pose.position, glm::dvec3(1.0, 0.0, -6.0)), 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(pose.rotation, parent.rotation)), 1.0, 1e-14);
  EXPECT_NEAR(glm::length(pose.rotation), 1.0, 1e-15);
}

TEST(ScriptedMotionTest, SameTimeGivesTheSameBits) {
  MotionScript script;
  MotionLink link;
  link.animated_rotation = {Interpolation::kLinear,
                            {0.0, 1.0},
                            {xyzw(glm::angleAxis(0.1, kUp)), xyzw(glm::angleAxis(1.3, kUp))}};
  script.links = {link};
  const Pose first = scripted_pose(script, 0.377);
  scripted_pose(script, 0.9);
  const Pose second = scripted_pose(script, 0.377);
  EXPECT_EQ(first.rotation, second.rotation);
  EXPECT_EQ(first.position, second.position);
}

}  // namespace
}  // namespace torsion::engine
