#include "systems/geometry/distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance_shapes.hpp"
#include "tests/support/distance_columns.hpp"

namespace torsion::engine {
namespace {

using Random = std::mt19937;

World world_with(const std::vector<ShapePart>& shapes) {
  World world;
  Capacities capacities;
  capacities.parts = static_cast<std::uint32_t>(shapes.size());
  world.model.reserve(capacities, Settings{});
  world.state.reserve(capacities, Settings{});
  for (const ShapePart& shape : shapes) {
    world.model.parts.at<ShapePart>(world.model.parts.append(1)->first) = shape;
  }
  return world;
}

ShapePart part_of(ShapeKind kind, const glm::dvec3& half_extent, const Pose& pose = {}) {
  ShapePart part;
  part.kind = kind;
  part.half_extent = half_extent;
  part.pose = pose;
  return part;
}

Distance distance_to(const ShapePart& part, const glm::dvec3& point) {
  return with_exact_shape(part,
                          [&](const auto& shape) { return shape(point.x, point.y, point.z); });
}

glm::dvec3 random_in_box(Random& random, const glm::dvec3& half) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double x = unit(random);
  const double y = unit(random);
  const double z = unit(random);
  return half * glm::dvec3(x, y, z);
}

glm::dvec3 random_direction(Random& random) {
  for (;;) {
    const glm::dvec3 v = random_in_box(random, glm::dvec3(1.0));
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1.0) {
      return v / length;
    }
  }
}

/// A shape with its definition as a set: the reference, written down without any distance.
struct Solid {
  std::string name;
  ShapePart part;
  std::function<bool(const glm::dvec3&)> contains;
};

const glm::dvec3 kBox(0.05, 0.03, 0.08);
const glm::dvec3 kAxes(0.08, 0.05, 0.06);

std::vector<Solid> solids() {
  return {{"sphere", part_of(ShapeKind::kSphere, glm::dvec3(0.05)),
           [](const glm::dvec3& p) {
             return glm::dot(p, p) <= 0.05 * 0.05;
           }},
          {"box", part_of(ShapeKind::kBox, kBox),
           [](const glm::dvec3& p) {
             return glm::all(glm::lessThanEqual(glm::abs(p), kBox));
           }},
          {"cylinder", part_of(ShapeKind::kCylinder, {0.04, 0.06, 0.04}),
           [](const glm::dvec3& p) {
             return std::abs(p.y) <= 0.06 && p.x * p.x + p.z * p.z <= 0.04 * 0.04;
           }},
          {"capsule", part_of(ShapeKind::kCapsule, {0.02, 0.06, 0.02}), [](const glm::dvec3& p) {
             const double y = std::max(std::abs(p.y) - 0.04, 0.0);
             return p.x * p.x + y * y + p.z * p.z <= 0.02 * 0.02;
           }}};
}

/// Points on a solid's surface: where rays from random points inside leave it, by bisection.
std::vector<glm::dvec3> surface_points(const Solid& solid, std::size_t count) {
  Random random(7);
  std::vector<glm::dvec3> points;
  while (points.size() < count) {
    const glm::dvec3 start = random_in_box(random, glm::dvec3(0.08));
    if (!solid.contains(start)) {
      continue;
    }
    const glm::dvec3 direction = random_direction(random);
    double inside = 0.0;
    double outside = 0.5;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (solid.contains(start + direction * middle) ? inside : outside) = middle;
    }
    points.push_back(start + direction * inside);
  }
  return points;
}

// Three facts together say that a number is the signed distance: its sign is that of the set; the
// surface is met at that distance, straight against the gradient; and no point of the surface is
// nearer.
TEST(ExactShapeTest, ValueAndGradientLeadToTheNearestPointOfTheSurface) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const std::vector<glm::dvec3> surface = surface_points(solid, 3000);
    Random random(11);
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 p = random_in_box(random, glm::dvec3(0.12));
      const Distance distance = distance_to(solid.part, p);
      EXPECT_EQ(distance.value <= 0.0, solid.contains(p));
      EXPECT_NEAR(glm::length(distance.gradient), 1.0, 1e-12);
      const glm::dvec3 foot = p - distance.value * distance.gradient;
      // Lengths of 0.1 m are rounded to 1e-17 a few times; 1e-12 m is far above that.
      EXPECT_TRUE(solid.contains(foot - 1e-12 * distance.gradient));
      EXPECT_FALSE(solid.contains(foot + 1e-12 * distance.gradient));
      for (const glm::dvec3& on_surface : surface) {
        ASSERT_GE(glm::distance(p, on_surface), std::abs(distance.value) - 1e-12);
      }
    }
  }
}

TEST(ExactShapeTest, GradientIsTheSlopeOfTheValue) {
  std::vector<Solid> all = solids();
  all.push_back({"ellipsoid", part_of(ShapeKind::kEllipsoid, kAxes), nullptr});
  constexpr double kStep = 1e-6;  // m
  for (const Solid& solid : all) {
    SCOPED_TRACE(solid.name);
    Random random(3);
    int compared = 0;
    for (int i = 0; i < 1500; ++i) {
      const glm::dvec3 p = random_in_box(random, glm::dvec3(0.1));
      const Distance distance = distance_to(solid.part, p);
      // An ellipsoid is a distance, and its gradient the value's slope, near its surface only.
      if (solid.name == "ellipsoid" && std::abs(distance.value) > 0.01) {
        continue;
      }
      glm::dvec3 slope;
      double kink = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = kStep;
        const double ahead = distance_to(solid.part, p + step).value;
        const double behind = distance_to(solid.part, p - step).value;
        slope[axis] = (ahead - behind) / (2.0 * kStep);
        kink = std::max(kink, std::abs(ahead + behind - 2.0 * distance.value) / kStep);
      }
      if (kink > 1e-2) {
        continue;  // a crease of the distance, where there is no gradient: edges' bisectors inside
      }
      // Central differences are off by step^2 / R^2, below 1e-7 at R = 5 mm; an ellipsoid's second
      // Newton step leaves some 1e-3 of the slope at a centimetre.
      const double tolerance = solid.name == "ellipsoid" ? 3e-3 : 2e-6;
      EXPECT_NEAR(glm::distance(slope, distance.gradient), 0.0, tolerance)
          << p.x << " " << p.y << " " << p.z;
      ++compared;
    }
    EXPECT_GT(compared, 100);
  }
}

TEST(ExactShapeTest, EllipsoidIsExactOnItsSurfaceAndNearlySoBesideIt) {
  const ShapePart part = part_of(ShapeKind::kEllipsoid, kAxes);
  Random random(5);
  double worst[2] = {0.0, 0.0};
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 on_sphere = random_direction(random);
    const glm::dvec3 surface = kAxes * on_sphere;
    const glm::dvec3 normal = glm::normalize(on_sphere / kAxes);
    const Distance at_surface = distance_to(part, surface);
    EXPECT_NEAR(at_surface.value, 0.0, 1e-16);
    EXPECT_NEAR(glm::distance(at_surface.gradient, normal), 0.0, 1e-14);
    // The smallest radius of curvature is 0.05^2 / 0.08 = 31 mm, so that h is the distance of both.
    for (int side = 0; side < 2; ++side) {
      for (const double h : {1e-3, -1e-3}) {
        const double scaled = side == 0 ? h : 4.0 * h;
        const double error = distance_to(part, surface + scaled * normal).value - scaled;
        worst[side] = std::max(worst[side], std::abs(error));
        EXPECT_LE(error, 1e-15);  // never more than the distance
      }
    }
  }
  // One Newton step errs by h^2 in the normal, two by h^4, and the value by the normal's square:
  // going four times as far must make more than 4^3 times the error. At 1 mm it is nothing.
  EXPECT_LT(worst[0], 1e-12);
  EXPECT_LT(worst[1], 1e-8);
  EXPECT_GT(worst[1], 64.0 * worst[0]);
}

TEST(ExactShapeTest, EllipsoidNeverExceedsTheDistanceAnywhereOutside) {
  const ShapePart part = part_of(ShapeKind::kEllipsoid, {0.1, 0.02, 0.05});
  const glm::dvec3 axes = part.half_extent;
  Random random(17);
  std::vector<glm::dvec3> surface;
  surface.reserve(4000);
  for (int i = 0; i < 4000; ++i) {
    surface.push_back(axes * random_direction(random));
  }
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 p = random_in_box(random, glm::dvec3(0.3));
    const glm::dvec3 scaled = p / axes;
    const double value = distance_to(part, p).value;
    EXPECT_EQ(value < 0.0, glm::dot(scaled, scaled) < 1.0);
    double nearest = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& on_surface : surface) {
      nearest = std::min(nearest, glm::distance(p, on_surface));
    }
    EXPECT_LE(std::abs(value), nearest * (1.0 + 1e-12));
  }
}

TEST(ExactShapeTest, MiddlesHaveAUnitGradientAndNanGivesNan) {
  std::vector<Solid> all = solids();
  all.push_back({"ellipsoid", part_of(ShapeKind::kEllipsoid, kAxes), nullptr});
  for (const Solid& solid : all) {
    SCOPED_TRACE(solid.name);
    const Distance middle = distance_to(solid.part, glm::dvec3(0.0));
    EXPECT_NEAR(glm::length(middle.gradient), 1.0, 1e-12);
    EXPECT_LT(middle.value, 0.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 bad(0.01);
      bad[axis] = nan;
      EXPECT_TRUE(std::isnan(distance_to(solid.part, bad).value)) << "axis " << axis;
    }
  }
}

/// A row of parts, some turned, some overlapping.
std::vector<ShapePart> mallet() {
  const glm::dquat turned = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 0.5)));
  return {part_of(ShapeKind::kSphere, glm::dvec3(0.03), {{0.1, 0.0, 0.02}, turned}),
          part_of(ShapeKind::kCylinder, {0.01, 0.1, 0.01}, {{0.02, 0.03, 0.0}, turned}),
          part_of(ShapeKind::kBox, {0.02, 0.03, 0.01}, {{-0.08, 0.01, 0.0}, turned}),
          part_of(ShapeKind::kEllipsoid, {0.02, 0.03, 0.025},
                  {{0.0, -0.05, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}),
          part_of(ShapeKind::kCapsule, {0.01, 0.04, 0.01},
                  {{0.0, 0.0, 0.1}, glm::dquat(0.6, 0.8, 0.0, 0.0)})};
}

TEST(UnionTest, IsTheNearestPartsDistanceInTheOwnersFrame) {
  const std::vector<ShapePart> parts = mallet();
  const World world = world_with(parts);
  Random random(23);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p = random_in_box(random, glm::dvec3(0.2));
    double nearest = std::numeric_limits<double>::infinity();
    glm::dvec3 gradient(0.0);
    for (const ShapePart& part : parts) {
      const Distance own =
          distance_to(part, glm::conjugate(part.pose.rotation) * (p - part.pose.position));
      if (own.value < nearest) {
        nearest = own.value;
        gradient = part.pose.rotation * own.gradient;
      }
    }
    const Distance all = signed_distance(world.model, {0, 5}, p);
    EXPECT_NEAR(all.value, nearest, 1e-15);
    EXPECT_NEAR(glm::distance(all.gradient, gradient), 0.0, 1e-12);
  }
}

TEST(UnionTest, ManyPointsAtOnceGiveWhatSinglePointsGive) {
  const World world = world_with(mallet());
  Random random(29);
  std::vector<glm::dvec3> points;
  points.reserve(100);
  for (int i = 0; i < 100; ++i) {  // no multiple of a block
    points.push_back(random_in_box(random, glm::dvec3(0.2)));
  }
  test::PointBatch batch(points);
  const DistanceColumns columns = batch.columns();
  std::vector<double> values(points.size());
  Pose frame;  // as seen from another frame, the points are elsewhere
  frame.position = {0.01, -0.02, 0.03};
  frame.rotation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
  for (const std::vector<std::uint32_t>& rows :
       {std::vector<std::uint32_t>{0, 1, 2, 3, 4}, {2, 3}, {4}}) {
    const Range parts{rows.front(), static_cast<std::uint32_t>(rows.size())};
    for (const Pose& seen_from : {Pose{}, frame}) {
      signed_distances(world.model, rows, seen_from, columns);
      distance_values(world.model, parts, seen_from, {columns.x, columns.y, columns.z}, values);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Distance single = signed_distance(
            world.model, parts, seen_from.rotation * points[i] + seen_from.position);
        // The turn by a matrix and by a quaternion round differently.
        EXPECT_NEAR(batch.at(i).value, single.value, 1e-15);
        EXPECT_NEAR(glm::distance(seen_from.rotation * batch.at(i).gradient, single.gradient), 0.0,
                    1e-12);
        EXPECT_EQ(values[i], batch.at(i).value);
      }
    }
  }
}

TEST(UnionTest, OfNothingIsInfinitelyFar) {
  const World world = world_with(mallet());
  EXPECT_EQ(signed_distance(world.model, {0, 0}, glm::dvec3(0.0)).value,
            std::numeric_limits<double>::infinity());
  const std::array<glm::dvec3, 3> points{};
  test::PointBatch batch(points);
  std::array<double, 3> values{};
  const DistanceColumns columns = batch.columns();
  signed_distances(world.model, {}, Pose{}, columns);
  distance_values(world.model, Range{0, 0}, Pose{}, {columns.x, columns.y, columns.z}, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(batch.at(i).value, std::numeric_limits<double>::infinity());
    EXPECT_EQ(values[i], std::numeric_limits<double>::infinity());
  }
}

TEST(PartsNearTest, KeepsEveryPartThatIsNearestToSomePointWithinReach) {
  const World world = world_with(mallet());
  std::array<std::uint32_t, 5> rows{};
  Random random(31);
  bool dropped_some = false;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 center = random_in_box(random, glm::dvec3(0.15));
    const double reach = 0.03;
    const auto near = parts_near(world.model, {0, 5}, center, reach, rows);
    ASSERT_FALSE(near.empty());
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    dropped_some = dropped_some || near.size() < 5;
    for (int j = 0; j < 30; ++j) {
      const glm::dvec3 p = center + random_direction(random) * reach;
      const Distance of_all = signed_distance(world.model, {0, 5}, p);
      test::PointBatch batch({&p, 1});
      signed_distances(world.model, near, Pose{}, batch.columns());
      EXPECT_NEAR(batch.at(0).value, of_all.value, 1e-15);
    }
  }
  EXPECT_TRUE(dropped_some);
}

}  // namespace
}  // namespace torsion::engine
