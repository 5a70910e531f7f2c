#pragma once

#include <glm/vec3.hpp>

namespace torsion {

/// Where a scene's contacts with a body are expected: a ball.
struct ExpectedPlace {
  bool known = false;      // false: anywhere
  glm::dvec3 center{0.0};  // m, body
  double radius = 0.0;     // m
};

}  // namespace torsion
