#pragma once

#include <span>
#include <vector>

#include "systems/model/finite_elements/compliance.hpp"

namespace torsion::engine {

/// Points spread over a solid's surface.
struct SurfacePoints {
  std::vector<Port> free;
  std::vector<glm::dvec3> clamped;  // m
  double area = 0.0;                // m^2, of both, roughly
};

/// The nearest surface point of each cell that the surface goes through.
/// @param cells_along  the longest side; 28 make some thousands of points
SurfacePoints sample_solid_surface(const ElasticSolid& solid, double cells_along = 28.0);

/// Whether the surface stays near the port's plane as far as `reach` around it.
bool is_smooth(const ElasticSolid& solid, const Port& port, double reach);

/// How far it is through the solid from a point of its surface, against the normal, m.
double thickness_at(const ElasticSolid& solid, const Port& port);

/// The same, but no more than that of any point which is nearer than the solid is thick there, m:
/// on the rim of a plate the plate's thickness, not its height.
/// @return (points)
std::vector<double> walls_at(const ElasticSolid& solid, std::span<const Port> points);

/// That of the solid's thin walls, m: of its free surface a tenth has less behind it.
double wall_thickness(const ElasticSolid& solid, const SurfacePoints& points);

}  // namespace torsion::engine
