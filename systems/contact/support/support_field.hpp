#pragma once

// The polynomial in which body model compliance moves the surface under a region.

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "ecs/components.hpp"

namespace torsion {

/// Degree of each of a SupportField's terms.
inline constexpr std::array<int, kSupportTerms> kSupportDegrees{0, 1, 1, 2, 2, 2, 3, 3,
                                                                3, 3, 4, 4, 4, 4, 4};

/// Coordinates of a point at most 1 from the origin: farther out the field goes on as it is at 1,
/// for a polynomial says nothing of what it was not fitted to.
inline glm::dvec2 support_coordinates(const glm::dvec2& point) {
  return point / std::max(1.0, glm::length(point));
}

/// The terms at a place: 1; x, y; x^2, x y, y^2; x^3, x^2 y, ...; ... y^4.
inline std::array<double, kSupportTerms> support_terms(const glm::dvec2& at) {
  const double x = at.x;
  const double y = at.y;
  const double xx = x * x;
  const double xy = x * y;
  const double yy = y * y;
  return {1.0,    x,      y,       xx,      xy,      yy,      xx * x, xx * y,
          yy * x, yy * y, xx * xx, xx * xy, xx * yy, xy * yy, yy * yy};
}

/// How far the field moves a point, m, body.
/// @param point  m, body
glm::dvec3 displacement_at(const SupportField& field, const glm::dvec3& point);

}  // namespace torsion
