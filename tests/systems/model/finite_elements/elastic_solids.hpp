#pragma once

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/model/finite_elements/compliance.hpp"

// Solids with exact distances, clamped at their lowest z. E = 1.
namespace torsion::engine {

inline bool is_lowest(const glm::dvec3& point, double height) {
  return point.z < 1e-6 * height;
}

/// A block that stands on z = 0 with the z axis in its middle.
inline ElasticSolid block_solid(const glm::dvec3& size, double poisson_ratio) {
  const glm::dvec3 half = 0.5 * size;
  const glm::dvec3 center(0.0, 0.0, half.z);
  const auto distance = [half, center](const glm::dvec3& point) {
    const glm::dvec3 from = point - center;
    const glm::dvec3 side(from.x < 0.0 ? -1.0 : 1.0, from.y < 0.0 ? -1.0 : 1.0,
                          from.z < 0.0 ? -1.0 : 1.0);
    const glm::dvec3 beyond = glm::abs(from) - half;
    const glm::dvec3 outside = glm::max(beyond, glm::dvec3(0.0));
    if (outside != glm::dvec3(0.0)) {
      return Distance{glm::length(outside), side * outside / glm::length(outside)};
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      axis = beyond[k] > beyond[axis] ? k : axis;
    }
    glm::dvec3 gradient(0.0);
    gradient[axis] = side[axis];
    return Distance{beyond[axis], gradient};
  };
  return {distance,
          {center - half, center + half},
          [size](const glm::dvec3& point) { return is_lowest(point, size.z); },
          {1.0, poisson_ratio, 1000.0}};
}

/// A round bar that stands on z = 0 about the z axis.
inline ElasticSolid round_bar(double radius, double height, double poisson_ratio) {
  const auto distance = [radius, height](const glm::dvec3& point) {
    const double from_axis = std::hypot(point.x, point.y);
    const glm::dvec3 outward =
        from_axis > 0.0 ? glm::dvec3(point.x, point.y, 0.0) / from_axis : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 upward(0.0, 0.0, point.z < 0.5 * height ? -1.0 : 1.0);
    const double side = from_axis - radius;
    const double end = std::abs(point.z - 0.5 * height) - 0.5 * height;
    if (side > 0.0 && end > 0.0) {
      const double rim = std::hypot(side, end);
      return Distance{rim, (side * outward + end * upward) / rim};
    }
    return side > end ? Distance{side, outward} : Distance{end, upward};
  };
  return {distance,
          {glm::dvec3(-radius, -radius, 0.0), glm::dvec3(radius, radius, height)},
          [height](const glm::dvec3& point) { return is_lowest(point, height); },
          {1.0, poisson_ratio, 1000.0}};
}

/// A ball about the origin, held where it is less than 0.15 of its diameter high.
inline ElasticSolid ball_solid(double radius, double poisson_ratio) {
  const auto distance = [radius](const glm::dvec3& point) {
    const double from = glm::length(point);
    return Distance{from - radius, from > 0.0 ? point / from : glm::dvec3(0.0, 0.0, 1.0)};
  };
  return {distance,
          {glm::dvec3(-radius), glm::dvec3(radius)},
          [radius](const glm::dvec3& point) { return point.z < -0.7 * radius; },
          {1.0, poisson_ratio, 1000.0}};
}

/// The port in the middle of the top of a block or bar.
inline Port top_port(double height) {
  return {glm::dvec3(0.0, 0.0, height), glm::dvec3(0.0, 0.0, 1.0)};
}

}  // namespace torsion::engine
