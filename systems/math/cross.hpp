#pragma once

#include <glm/vec2.hpp>

namespace torsion {

/// The cross product of two vectors of a plane: the signed area of the parallelogram they span.
inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace torsion
