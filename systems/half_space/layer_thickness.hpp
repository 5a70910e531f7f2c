#pragma once

#include <cstdint>

#include "ecs/model.hpp"

namespace torsion {

/// Whether a body is a layer on its fixed face: at least four times as wide as thick.
bool is_layer(const Model& model, std::uint32_t body);

/// Thickness at a point of the surface, m, with that normal, of a body that is a layer there; 0 for
/// others.
double layer_thickness(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                       const glm::dvec3& point);

}  // namespace torsion
