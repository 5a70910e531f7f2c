#include "device/composite.hpp"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

class CarriedToolTest : public testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] glm::dvec3 random_vector(double size) {
    std::uniform_real_distribution<double> number(-size, size);
    const double x = number(random_);
    const double y = number(random_);
    return {x, y, number(random_)};
  }
  std::mt19937 random_{3};
};

TEST_P(CarriedToolTest, KnowsThePoseThatItsPointsWereMovedBy) {
  const std::size_t count = GetParam();
  const CarriedTool tool = carried_at(count, 0.2);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 shift = random_vector(0.05);
    glm::dvec3 axis = glm::normalize(random_vector(1.0));
    if (count == 2) {
      // Turns about the line between the points cannot be seen.
      axis = glm::normalize(glm::dvec3(0.0, axis.y, axis.z));
    }
    const glm::dquat turn = glm::angleAxis(random_vector(1.0).x, axis);
    std::array<glm::dvec3, kMostPoints> places{};
    for (std::size_t p = 0; p < count; ++p) {
      places[p] = turn * tool.points[p] + shift - tool.points[p];
    }
    const Pose pose = carried_pose(tool, std::span(places).first(count));
    EXPECT_NEAR(glm::length(pose.position - shift), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(glm::dot(pose.rotation, turn)), 1.0, 1e-12);
  }
}

TEST_P(CarriedToolTest, ForcesComeToTheWrenchAndAreTheLeast) {
  const std::size_t count = GetParam();
  const CarriedTool tool = carried_at(count, 0.2);
  for (int i = 0; i < 100; ++i) {
    std::array<glm::dvec3, kMostPoints> places{};
    for (std::size_t p = 0; p < count; ++p) {
      places[p] = random_vector(0.03);
    }
    const auto used = std::span(places).first(count);
    const Pose pose = carried_pose(tool, used);
    const Wrench wrench{random_vector(5.0), random_vector(0.5)};
    std::array<glm::dvec3, kMostPoints> forces{};
    carried_forces(tool, used, wrench, forces);
    glm::dvec3 force(0.0);
    glm::dvec3 torque(0.0);
    std::array<glm::dvec3, kMostPoints> now{};
    for (std::size_t p = 0; p < count; ++p) {
      now[p] = tool.points[p] + places[p];
      force += forces[p];
      torque += glm::cross(now[p] - pose.position, forces[p]);
    }
    EXPECT_NEAR(glm::length(force - wrench.force), 0.0, 1e-12);
    glm::dvec3 missing = wrench.torque - torque;
    if (count == 2) {
      const glm::dvec3 line = glm::normalize(now[1] - now[0]);
      missing -= line * glm::dot(missing, line);
    }
    EXPECT_NEAR(glm::length(missing), 0.0, 1e-12);
    // Forces that only press two points together do nothing to the tool: the least norm has none.
    for (std::size_t p = 0; p < count; ++p) {
      const std::size_t q = (p + 1) % count;
      const glm::dvec3 line = glm::normalize(now[q] - now[p]);
      EXPECT_NEAR(glm::dot(line, forces[q] - forces[p]), 0.0, 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TwoAndThree, CarriedToolTest, testing::Values(2, 3));

}  // namespace
}  // namespace torsion::engine
