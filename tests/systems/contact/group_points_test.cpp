#include "systems/contact/group_points.hpp"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/math/disjoint_sets.hpp"

namespace torsion::engine {
namespace {

struct Groups {
  std::uint32_t count;
  std::vector<std::uint32_t> of;
};

Groups grouped(const std::vector<glm::dvec3>& points, double threshold,
               const std::vector<std::pair<std::uint32_t, std::uint32_t>>& known = {}) {
  std::vector<std::uint32_t> order(points.size());
  std::vector<std::uint32_t> parent(points.size());
  Groups groups{0, std::vector<std::uint32_t>(points.size())};
  PointLinks links = no_links(parent);
  for (const auto& [first, second] : known) {
    links.sets -= link(links.parent, first, second) ? 1U : 0U;
  }
  groups.count = group_points(points, threshold, links, order, groups.of);
  return groups;
}

TEST(GroupPointsTest, NoPointsAreNoGroups) {
  EXPECT_EQ(grouped({}, 1.0).count, 0U);
}

TEST(GroupPointsTest, AChainOfShortLinksIsOneGroup) {
  std::vector<glm::dvec3> chain;
  for (int i = 0; i < 50; ++i) {
    chain.emplace_back(0.875 * i, 0.0, 0.0);
  }
  EXPECT_EQ(grouped(chain, 1.0).count, 1U);
  // Exactly r_th apart is not "less than a threshold".
  EXPECT_EQ(grouped(chain, 0.875).count, 50U);
}

TEST(GroupPointsTest, TwoRingsOneInsideTheOtherAreTwoGroups) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 60; ++i) {
    const double angle = 6.283185307179586 * i / 60;
    points.emplace_back(std::cos(angle), 0.0, std::sin(angle));
    points.emplace_back(3.0 * std::cos(angle), 0.0, 3.0 * std::sin(angle));
  }
  const Groups groups = grouped(points, 0.5);
  EXPECT_EQ(groups.count, 2U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(groups.of[i], i % 2);
  }
}

TEST(GroupPointsTest, GroupsAreNumberedByTheirFirstPoint) {
  const Groups groups = grouped({{9, 0, 0}, {0, 0, 0}, {9.5, 0, 0}, {4, 0, 0}}, 1.0);
  EXPECT_EQ(groups.of, (std::vector<std::uint32_t>{0, 1, 0, 2}));
}

/// The definition itself: grow groups until no two of them have points closer than the threshold.
std::vector<std::uint32_t> brute_force(const std::vector<glm::dvec3>& points, double threshold) {
  std::vector<std::uint32_t> of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    of[i] = static_cast<std::uint32_t>(i);
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        if (of[i] < of[j] && glm::length(points[i] - points[j]) < threshold) {
          of[j] = of[i];
          changed = true;
        }
      }
    }
  }
  return of;
}

TEST(GroupPointsTest, AgreesWithTheDefinitionOnRandomPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<glm::dvec3> points(80);
    for (glm::dvec3& point : points) {
      point = {place(random), place(random), trial % 2 == 0 ? 0.0 : place(random)};
    }
    const Groups groups = grouped(points, 0.12);
    const std::vector<std::uint32_t> expected = brute_force(points, 0.12);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_EQ(groups.of[i] == groups.of[j], expected[i] == expected[j]);
      }
    }
  }
}

TEST(GroupPointsTest, KnownLinksChangeNothing) {
  // A row of ten with a gap of one and a half in its middle, threshold 1.2.
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 10; ++i) {
    points.emplace_back(i + (i < 5 ? 0.0 : 0.5), 0.0, 0.0);
  }
  const Groups without = grouped(points, 1.2);
  ASSERT_EQ(without.count, 2U);
  const Groups with = grouped(points, 1.2, {{0, 1}, {3, 2}, {8, 9}, {0, 1}});
  EXPECT_EQ(with.count, without.count);
  EXPECT_EQ(with.of, without.of);
}

TEST(GroupPointsTest, LinksThatJoinAllAreEnough) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(grouped(points, 1.2, {{0, 1}, {1, 2}}).count, 1U);
}

}  // namespace
}  // namespace torsion::engine
