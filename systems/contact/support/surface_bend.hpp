#pragma once

#include "ecs/model.hpp"
#include "systems/half_space/curved_influence.hpp"

namespace torsion {

/// How a body bends away from the half-space that its contact is taken for, and up to where the
/// contact has to know.
struct SurfaceBend {
  SurfaceCurvature curvature;  // in the axes asked for
  double reach = 0.0;          // m; 0: flat
};

/// Of the surface around a contact. What the curvature adds to a half-space's response goes with
/// the logarithm of the distance (curved_influence.hpp), so that the ports, and the elements
/// between them, know only the part at their own distances. `reach` is the distance at which they
/// have it: the mean, in logarithms, over what the footing makes of the ports.
/// @param across  m: of the contact
SurfaceBend find_surface_bend(const Model& model, std::uint32_t body, const Footing& footing,
                              const RegionFrame& axes, double across);

/// Whether any surface of the body may be curved at all.
bool may_bend(const Model& model, std::uint32_t body);

}  // namespace torsion
