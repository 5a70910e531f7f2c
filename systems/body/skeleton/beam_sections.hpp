#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/model.hpp"

namespace torsion::engine {

/// Area and moments of a polygon, about its centroid.
struct PolygonMoments {
  double area = 0.0;         // m^2
  glm::dvec2 centroid{0.0};  // m
  double xx = 0.0;           // integral of y^2, m^4
  double yy = 0.0;           // integral of x^2, m^4
  double xy = 0.0;           // integral of x y, m^4
};

/// @param polygon  corners counter-clockwise, m; at least 3
PolygonMoments polygon_moments(const std::vector<glm::dvec2>& polygon);

/// Saint-Venant's torsion constant J [m^4] of a simple polygon: 2 x the integral of Prandtl's
/// stress function, which is a harmonic polynomial minus r^2/2, fitted to be zero on the boundary
/// (Trefftz' method, least squares).
/// @param polygon  corners counter-clockwise, m; star-shaped about its centroid or nearly so
double torsion_constant(const std::vector<glm::dvec2>& polygon);

/// Two unit vectors that make a right-handed frame with `direction`: those that belong to
/// `reference`, carried over by the smallest turn. Continuous except where direction = -reference.
/// @param direction, reference  unit
struct TransverseAxes {
  glm::dvec3 first{0.0};
  glm::dvec3 second{0.0};
};
TransverseAxes transverse_axes(const glm::dvec3& direction, const glm::dvec3& reference);

/// The direction in which a body's beams point on the whole: unit, body frame. For a fixed face its
/// normal, else from the fixed point to the middle of the body's box.
glm::dvec3 beam_reference(const FixedRegion& fixed, const Bounds& bounds);

}  // namespace torsion::engine
