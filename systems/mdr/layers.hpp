#pragma once

// Tangential and torsional springs of a round contact with history: the method of dimensionality
// reduction, with sliding and spinning coupled through the exact limit curve.

#include <span>

#include <glm/vec2.hpp>

#include "ecs/components.hpp"
#include "systems/mdr/places.hpp"

namespace torsion::engine {

/// One contact's springs in one step. `on tool` is where forces act.
struct MdrContact {
  double radius = 0.0;           // a, m
  double force = 0.0;            // F_n, N
  double flat_share = 0.0;       // of F_n by a flat punch's pressure, the rest by a paraboloid's
  double friction = 0.0;         // mu
  double shear_modulus = 0.0;    // G, Pa
  double poisson_ratio = 0.0;    // nu
  double slide_stiffness = 1.0;  // over 8 G a / (2 - nu), that of a round contact of radius a
  double turn_stiffness = 1.0;   // over 16 / 3 G a^3
  double torque_share = 1.0;     // largest couple over that of a round contact of radius a
  glm::dvec2 slide{0.0};         // m, this step
  double spin = 0.0;             // rad, this step
};

struct MdrForces {
  glm::dvec2 force{0.0};      // N, on the tool
  double couple = 0.0;        // N m, on the tool
  double stick_radius = 0.0;  // over a: within it no layer slips in this step
  double slipped = 0.0;       // m: mean plastic slide, with a times the plastic spin
};

/// Where springs sat in the last step or sit in this one.
struct MdrSize {
  const MdrPlaces& places;
  double radius = 0.0;  // m
};

/// Moves the springs to where they are on a contact that was `before` and is `now`: what is new has
/// no deflection, what is gone is lost. The deflection is projected piece by piece in the metric of
/// its elastic energy (least squares), so that no energy comes of it, and linear ones stay what
/// they are.
void resize_layers(const MdrSize& before, const MdrSize& now, std::span<MdrLayer> layers);

/// One step of all layers: elastic trial, then back onto the limit curve. Dissipates at every step.
MdrForces move_layers(const MdrPlaces& places, const LimitCurve& curve, const MdrContact& contact,
                      std::span<MdrLayer> layers);

}  // namespace torsion::engine
