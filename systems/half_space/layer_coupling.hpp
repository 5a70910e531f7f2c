#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>

#include "ecs/model.hpp"

namespace torsion {

/// Displacement at one place of a layer by a force at another one, less the half-space's: body
/// axes, m/N. Its transpose is the other way round.
/// @param body       with a layer's kernel (OwnedRows::influences)
/// @param normal     body, unit, out of the layer
/// @param offset     m, body: from the force
/// @param thickness  m
glm::dmat3 layer_coupling(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                          const glm::dvec3& offset, double thickness);

/// Whether the body has a layer's kernel.
bool has_layer_kernel(const Model& model, std::uint32_t body);

}  // namespace torsion
