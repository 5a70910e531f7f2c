#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace torsion {

/// An elastic half-space under its surface; the surface goes through where a force acts.
struct HalfSpace {
  glm::dvec3 normal{0.0};      // unit, outward
  double shear_modulus = 0.0;  // G, Pa
  double poisson_ratio = 0.0;  // nu
};

/// Displacement [m] by a force on the surface that is spread over a width: Boussinesq's and
/// Cerruti's solutions with the distance R replaced by sqrt(R^2 + spread^2), so that it is finite
/// at the force and exact far from it. A point above the surface counts as on it.
/// @param away   m: from the force to the point
/// @param force  N, on the material
/// Source: Johnson, Contact Mechanics (1985), eq. 3.18 and 3.75.
inline glm::dvec3 displacement_by_force(const HalfSpace& half_space, const glm::dvec3& away,
                                        const glm::dvec3& force, double spread) {
  const double height = glm::dot(away, half_space.normal);
  const double z = std::max(-height, 0.0);  // depth
  const glm::dvec3 across = away - half_space.normal * height;
  const double r = std::sqrt(glm::dot(across, across) + z * z + spread * spread);
  const double inverse = 1.0 / r;
  const double cube = inverse * inverse * inverse;
  const double free = 1.0 - 2.0 * half_space.poisson_ratio;
  const double sum = 1.0 / (r + z);
  const double pressing = -glm::dot(force, half_space.normal);
  const glm::dvec3 drag = force + half_space.normal * pressing;
  const double along = glm::dot(drag, across);
  // Boussinesq, then Cerruti; positive depth is against the normal.
  const glm::dvec3 lateral = across * (pressing * (z * cube - free * inverse * sum) +
                                       along * (cube - free * inverse * sum * sum)) +
                             drag * (inverse + free * sum);
  const double down = pressing * (z * z * cube + 2.0 * (1.0 - half_space.poisson_ratio) * inverse) +
                      along * (z * cube + free * inverse * sum);
  return (lateral - half_space.normal * down) / (4.0 * std::numbers::pi * half_space.shear_modulus);
}

}  // namespace torsion
