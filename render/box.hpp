#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace torsion::engine {

/// The box around points; empty before the first.
struct Box {
  glm::dvec3 lowest{std::numeric_limits<double>::infinity()};
  glm::dvec3 highest{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& point) {
    lowest = glm::min(lowest, point);
    highest = glm::max(highest, point);
  }
  [[nodiscard]] bool empty() const { return lowest.x > highest.x; }
  [[nodiscard]] glm::dvec3 center() const {
    return empty() ? glm::dvec3(0.0) : 0.5 * (lowest + highest);
  }
  [[nodiscard]] glm::dvec3 size() const { return empty() ? glm::dvec3(0.0) : highest - lowest; }
  [[nodiscard]] double largest_side() const {
    const glm::dvec3 sides = size();
    return std::max({sides.x, sides.y, sides.z});
  }
};

inline Box box_of(std::span<const glm::vec3> points) {
  Box box;
  for (const glm::vec3& point : points) {
    box.add(glm::dvec3(point));
  }
  return box;
}

}  // namespace torsion::engine
