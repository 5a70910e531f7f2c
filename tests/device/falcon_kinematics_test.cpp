#include "device/protocols/falcon_kinematics.hpp"

#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

glm::dvec3 random_position(std::mt19937& random) {
  std::uniform_real_distribution<double> aside(-0.04, 0.04);
  std::uniform_real_distribution<double> out(0.09, 0.14);
  const double x = aside(random);
  const double y = aside(random);
  return {x, y, out(random)};
}

TEST(FalconKinematicsTest, HasTheAnglesOfKnownPoses) {
  // An independent computation with the same lengths, to 1e-6 degrees.
  const std::pair<glm::dvec3, glm::dvec3> poses[] = {
      {{0.0, 0.0, 0.11}, {16.18796, 16.18796, 16.18796}},
      {{0.02, 0.0, 0.11}, {22.198145, 3.803494, 27.362316}},
      {{0.0, 0.03, 0.12}, {8.370357, 32.576855, 41.027291}},
      {{-0.03, 0.02, 0.10}, {-7.744004, 37.649369, 10.58182}}};
  for (const auto& [position, degrees] : poses) {
    const auto angles = falcon_inverse(position);
    ASSERT_TRUE(angles);
    EXPECT_LT(glm::distance(*angles, degrees * kDegree), 1e-6 * kDegree * 4.0);
  }
}

TEST(FalconKinematicsTest, ForwardUndoesInverse) {
  std::mt19937 random(3);
  glm::dvec3 last(0.0, 0.0, 0.11);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 position = random_position(random);
    const auto angles = falcon_inverse(position);
    ASSERT_TRUE(angles);
    const auto found = falcon_forward(*angles, last);
    ASSERT_TRUE(found) << i;
    // The angles agree within 1e-12 rad, and 1 rad is at most 0.2 m.
    EXPECT_LT(glm::distance(*found, position), 1e-12);
    last = *found;
  }
}

TEST(FalconKinematicsTest, JacobianIsTheDerivative) {
  std::mt19937 random(4);
  constexpr double kStep = 1e-6;  // m: differences are then exact to about 1e-9 of the value
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 position = random_position(random);
    const glm::dmat3 jacobian = falcon_jacobian(position);
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = kStep;
      const glm::dvec3 difference =
          (*falcon_inverse(position + step) - *falcon_inverse(position - step)) / (2.0 * kStep);
      EXPECT_LT(glm::distance(jacobian[axis], difference), 1e-6 * glm::length(difference));
    }
  }
}

TEST(FalconKinematicsTest, MotorsHaveThePowerOfTheForce) {
  const glm::dvec3 middle(0.0, 0.0, 0.11);
  // 1 N along z is 0.02418 N m in each joint, and 4000 motor values are 1 N m.
  EXPECT_EQ(falcon_motors(middle, {0.0, 0.0, 1.0}), (std::array<std::int16_t, 3>{-97, -97, -97}));
}

TEST(FalconKinematicsTest, KeepsTheDirectionOfForcesThatAreTooLarge) {
  const glm::dvec3 position(0.02, -0.01, 0.12);
  const glm::dvec3 force(3.0, -5.0, 2.0);
  const auto small = falcon_motors(position, force);
  const auto large = falcon_motors(position, 1000.0 * force);
  const auto reach = [](const auto& motors) {
    int most = 0;
    for (const std::int16_t motor : motors) {
      most = std::max(most, std::abs(int{motor}));
    }
    return most;
  };
  EXPECT_EQ(reach(large), kFalconLargestMotor);
  for (std::size_t motor = 0; motor < 3; ++motor) {
    // The small values are rounded to whole numbers.
    EXPECT_NEAR(large[motor], small[motor] * (4095.0 / reach(small)), 0.5 + 4095.0 / reach(small));
  }
}

TEST(FalconKinematicsTest, FindsNothingOutOfReachAndSendsNothingThere) {
  EXPECT_FALSE(falcon_inverse({0.0, 0.0, 1.0}));
  EXPECT_FALSE(falcon_inverse(glm::dvec3(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(
      falcon_forward(glm::dvec3(std::numeric_limits<double>::quiet_NaN()), {0.0, 0.0, 0.11}));
  EXPECT_EQ(falcon_motors({0.0, 0.0, 1.0}, glm::dvec3(1.0)), (std::array<std::int16_t, 3>{}));
  EXPECT_EQ(falcon_motors({0.0, 0.0, 0.11}, glm::dvec3(std::numeric_limits<double>::infinity())),
            (std::array<std::int16_t, 3>{}));
}

TEST(FalconKinematicsTest, ACountIsAThirtiethOfADegree) {
  const glm::dvec3 step = falcon_joint_angles({{1, 0, 0}}) - falcon_joint_angles({});
  EXPECT_NEAR(step.x / kDegree, 0.03643, 1e-5);
  EXPECT_NEAR(falcon_joint_angles({}).y / kDegree, 35.0, 1e-12);
}

}  // namespace
}  // namespace torsion::engine
