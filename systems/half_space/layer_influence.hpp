#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "systems/half_space/influence.hpp"

namespace torsion {

/// Number of values of one grid's tables on a layer.
constexpr std::size_t layer_influence_count(std::uint32_t side) {
  return kInfluenceKinds * (2 * std::size_t{side} - 1) * (2 * std::size_t{side});
}

/// Tables for a grid on a layer bonded to a rigid base: the half-space's and what the layer is
/// beside it, which is smooth and taken at four points of a cell (Gauss).
/// @param half_space  tables of the grid's aspect
/// @param kernel      what fill_layer_kernel has filled
/// @param cell        of the grid, over the layer's thickness
/// @param values      (layer_influence_count(side)) out
void fill_layer_influences(const InfluenceTables& half_space, std::span<const double> kernel,
                           double poisson_ratio, const glm::dvec2& cell, std::span<double> values);

/// The tables that those are.
InfluenceTables layer_influence_tables(std::span<const double> values, std::uint32_t side);

}  // namespace torsion
