#pragma once

// The contact of a region as contact model mdr has it: round, or nearly so.

#include <cstdint>

#include <glm/vec2.hpp>

#include "ecs/state.hpp"
#include "systems/mdr/places.hpp"

namespace torsion {

/// What a region's overlap says of its contact.
struct RoundContact {
  glm::dvec2 center{0.0};  // m, grid
  double radius = 0.0;     // m: sqrt(a b)
  double depth = 0.0;      // m
  double force = 0.0;      // N
  MdrPressure pressure;
  // Over those of a round contact of the same radius and force.
  double slide_stiffness = 1.0;
  double turn_stiffness = 1.0;
  double torque_share = 1.0;
};

/// From the shapes where those are known, else from the region's cells.
RoundContact round_contact(const Model& model, const State& state, std::uint32_t region);

/// dF/dd, which of all round contacts is 2 E* a. Source: Popov and Hess, 2015, 2.2.
/// @param modulus  E*, Pa
double normal_slope(const RoundContact& contact, double modulus);

/// The contact at another depth: near its own, d, its force goes with a power m of that, by its
/// slope there, and so its radius with the power m - 1.
/// @param depth  m, > 0
RoundContact pressed_to(double depth, double modulus, RoundContact contact);

/// Normal force on a bonded incompressible or compressible layer over that on a half-space, at
/// equal depth. Within 2 % up to chi = 0.26 (nu = 0.5), 7.7 % off at 0.5;
/// larger values are taken as 0.5. Source:
/// Dimitriadis et al., Biophys. J. 82 (2002) 2798.
/// @param chi  sqrt(R depth) / thickness
double layer_force_share(double chi, double poisson_ratio);

}  // namespace torsion
