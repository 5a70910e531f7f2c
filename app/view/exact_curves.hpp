#pragma once

#include <cstdint>
#include <optional>

#include "app/view/history.hpp"
#include "app/view/plots.hpp"
#include "ecs/model.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// What the exact solutions need of a sphere on an elastic body with Coulomb's friction.
struct ExactContact {
  double sphere_radius = 0.0;  // m
  double modulus = 0.0;        // E / (1 - nu^2), Pa
  double shear_modulus = 0.0;  // Pa
  double friction = 0.0;       // mu
};

/// m: of the contact's disc at a normal force, whatever the model in use takes (Sneddon).
double exact_radius(const ExactContact& contact, double force);

/// Nothing where they are not for the scene: the tool is more than one sphere, what sticks holds
/// more than what slips, or bodies differ.
std::optional<ExactContact> exact_contact(const SceneDescription& scene, const Model& model,
                                          std::uint32_t tool);

/// The couple against the tool's turn, deg and N m, that the sphere would have on a body without
/// end at the same force: Lubkin's solution, with Masing's rule where the turn goes back
/// (docs/models.md). It begins where the contact formed without a turn, and ends where the force
/// leaves 3 % of what it was when the turn began, or friction takes 5 % of its limit sideways.
Curve exact_over_turn(const History& history, std::uint64_t generation,
                      const ExactContact& contact);

/// The couple against the friction force, N m and N, of a contact that slips as a whole, sliding
/// and spinning at once (Contensou; Zhuravlev).
/// @param force  N, normal
Curve exact_limit(double force, const ExactContact& contact);

}  // namespace torsion::engine
