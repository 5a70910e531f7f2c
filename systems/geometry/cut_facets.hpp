#pragma once

// Triangles cut along other triangles.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/components/bodies.hpp"
#include "ecs/surface.hpp"

namespace torsion {

struct Facet {
  std::array<glm::dvec3, 3> corner;  // m
  glm::dvec3 normal{0.0};            // unit; zero without area
  Bounds box;
};

/// A convex, flat piece of a triangle: its corners in order, m.
using Polygon = std::vector<glm::dvec3>;

/// One for each triangle.
std::vector<Facet> facets_of(const SurfaceMesh& mesh);

/// True where all corners of `a` lie in the plane of `b`.
/// @param same  m: places nearer than that are one, here and below
bool is_coplanar(const Facet& a, const Facet& b, double same);

/// True where two facets cross or touch along a line, or are coplanar.
bool do_cross(const Facet& a, const Facet& b, double same);

/// True where a place in a facet's plane lies within its edges.
bool is_in(const Facet& facet, const glm::dvec3& place);

/// Cuts the pieces of a facet along another one.
void cut_by(std::vector<Polygon>& pieces, const Facet& facet, const Facet& other, double same);

}  // namespace torsion
