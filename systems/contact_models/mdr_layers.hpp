#pragma once

// Tangential and torsional springs of a round contact with history: the method of dimensionality
// reduction, with sliding and spinning coupled through the exact limit curve.

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "ecs/components.hpp"
#include "systems/contact_models/limit_curve.hpp"

namespace torsion {

/// Of one layer: where its spring sits in the one-dimensional foundation and at which deflection it
/// slips. Layer k slips after the same share of the whole friction has slipped in pure sliding as
/// in pure spinning, so all layers have limit curves of one shape and their sum never leaves it.
struct MdrThreshold {
  double shift_place = 0.0;  // x / a of the tangential spring
  double shift_limit = 0.0;  // deflection at slip over mu F / (Gt a)
  double turn_place = 0.0;   // x / a of the torsional spring
  double turn_limit = 0.0;   // turn at slip over mu F / (G a^2)
};

using MdrThresholds = std::array<MdrThreshold, kMdrLayers>;

/// What the return map needs to know of contacts of any pressure between a paraboloid's and a flat
/// punch's.
struct MdrTables {
  static constexpr std::size_t kShapes = 9;  // flat shares 0, 1/8, ..., 1
  std::array<MdrThresholds, kShapes> thresholds{};
  LimitCurve limit_curve;
};

/// Source: Popov & Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction, 2015
/// (normal and tangential springs); the torsional thresholds are the Abel transform of the pressure
/// (docs/models.md).
MdrTables make_mdr_tables();

/// One contact's springs in one step. `on tool` is where forces act.
struct MdrContact {
  double radius = 0.0;         // a, m
  double force = 0.0;          // F_n, N
  double flat_share = 0.0;     // of F_n by a flat punch's pressure, the rest by a paraboloid's
  double friction = 0.0;       // mu
  double shear_modulus = 0.0;  // G, Pa
  double poisson_ratio = 0.0;  // nu
  double torque_share = 1.0;   // largest couple over that of a round contact of radius a
  glm::dvec2 slide{0.0};       // m, this step
  double spin = 0.0;           // rad, this step
};

struct MdrForces {
  glm::dvec2 force{0.0};     // N, on the tool
  double couple = 0.0;       // N m, on the tool
  double stick_share = 0.0;  // of the layers
  double slipped = 0.0;      // m: mean plastic slide, with a times the plastic spin
};

/// Moves the springs to where they are on a contact whose radius changed from `before` to `radius`:
/// what is new has no deflection, what is gone is lost.
void resize_layers(const MdrThresholds& thresholds, double before, double radius,
                   std::span<MdrLayer> layers);

/// One step of all layers: elastic trial, then back onto the limit curve. Dissipates at every step.
MdrForces move_layers(const MdrTables& tables, const MdrContact& contact,
                      std::span<MdrLayer> layers);

/// The thresholds of a pressure between two of the tables.
MdrThresholds thresholds_of(const MdrTables& tables, double flat_share);

}  // namespace torsion
