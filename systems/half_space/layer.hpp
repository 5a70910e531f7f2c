#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "ecs/model.hpp"
#include "systems/half_space/influence.hpp"

namespace torsion::engine {

/// Whether a body is a layer on its fixed face: at least four times as wide as thick.
bool is_layer(const Model& model, std::uint32_t body);

/// Thickness at a point of the surface, m, with that normal, of a body that is a layer there; 0 for
/// others.
double layer_thickness(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                       const glm::dvec3& point);

// How a point force on an elastic layer, bonded to a rigid base, displaces the layer's surface
// beyond what it would do to a half-space: a smooth function of the distance.

/// Compliance of the surface under waves of wave number k, times G k; u = k h, h the thickness.
/// Tractions and displacements along the wave and across it go with sin and cos of one phase:
/// pressure p cos(kx) sinks the surface by `sinking` p cos(kx) and moves it by -`mixed` p sin(kx)
/// along x; traction q sin(kx) along x moves it by `along` q sin(kx) and sinks it by -`mixed` q
/// cos(kx); traction across moves it by `across` times itself.
struct WaveCompliance {
  double sinking = 0.0;
  double along = 0.0;
  double across = 0.0;
  double mixed = 0.0;
};

/// A layer's, less the half-space's (1 - nu, 1 - nu, 1, (1 - 2 nu) / 2).
/// Source: Navier's equations with displacement zero at the base: U = (alpha - z P / 2) exp(-kz)
/// and so on, P the dilatation over 1 - 2 nu, finite at nu = 0.5 (docs/models.md, "Layers"); across
/// the wave tanh(u).
/// @param u  > 0
WaveCompliance layer_wave_compliance(double poisson_ratio, double u);

inline constexpr std::size_t kLayerSteps = 768;
inline constexpr double kLayerReach = 12.0;  // thicknesses: there the layer hardly moves any more
/// Numbers that describe the kernel of one Poisson's ratio.
inline constexpr std::size_t kLayerKernelSize = 4 * (kLayerSteps + 1);

/// Fills the inverse Hankel transforms of that compliance by Gauss-Legendre quadrature.
/// @param kernel  (kLayerKernelSize) out
void fill_layer_kernel(double poisson_ratio, std::span<double> kernel);

/// Displacement (first letter) by a unit traction (second letter), as InfluenceKind, less the
/// half-space's, times G h, over the force.
struct LayerResponse {
  double zz = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  double zx = 0.0;
  double zy = 0.0;
};

/// @param offset  from the force, over the thickness
LayerResponse layer_response(std::span<const double> kernel, double poisson_ratio,
                             const glm::dvec2& offset);

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

/// Displacement at one place of a layer by a force at another one, less the half-space's: body
/// axes, m/N. Its transpose is the other way round.
/// @param body       with a layer's kernel (layer_kernel)
/// @param normal     body, unit, out of the layer
/// @param offset     m, body: from the force
/// @param thickness  m
glm::dmat3 layer_coupling(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                          const glm::dvec3& offset, double thickness);

/// The kernel of a body that contacts take for a layer: (kLayerKernelSize), or none.
std::span<const double> layer_kernel(const Model& model, std::uint32_t body);

}  // namespace torsion::engine
