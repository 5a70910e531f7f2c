#pragma once

#include <cstdint>

#include "ecs/model.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

// How near a region is to where linear elasticity ends, which every model here is: docs/models.md,
// Large strain.

inline constexpr double kLargeTraction = 0.2;  // over E*
inline constexpr double kLargeTilt = 0.3;      // rad

/// The mean traction of a region's contact over E* = E / (1 - nu^2), as the strain under it is; 0
/// where it has no area. Of a ball's contact without friction it is 0.42 a / R (Hertz).
double traction_over_modulus(const Model& model, const State& state, std::uint32_t region);

/// How far the body's deformation as a whole has tilted the surface under a region, rad.
double support_tilt(const State& state, std::uint32_t region);

}  // namespace torsion::engine
