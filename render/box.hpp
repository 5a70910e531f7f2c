#pragma once

#include <limits>

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
};

}  // namespace torsion::engine
