#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "systems/mdr/layers.hpp"
#include "tests/reference/exact/cattaneo_mindlin.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/limit_surface.hpp"
#include "tests/reference/exact/lubkin.hpp"

namespace torsion::engine::test {

inline constexpr double kShearModulus = 1e6;  // Pa
inline constexpr double kFriction = 0.75;
inline constexpr double kSphereRadius = 0.05;  // m
inline constexpr double kDepth = 4e-4;         // m

inline const MdrTables& mdr_tables() {
  static const MdrTables made = make_mdr_tables();
  return made;
}

/// The springs of a sphere's contact with a half-space, driven by hand.
class MdrSprings {
 public:
  explicit MdrSprings(double poisson, double depth = kDepth) {
    contact.poisson_ratio = poisson;
    contact.friction = kFriction;
    contact.shear_modulus = kShearModulus;
    press(depth);
  }

  /// To another depth; nothing moves sideways.
  void press(double depth) {
    const reference::HertzSphere sphere = reference::hertz_sphere_at_depth(
        kSphereRadius, 2.0 * kShearModulus / (1.0 - contact.poisson_ratio), depth);
    const double before = contact.radius;
    contact.radius = sphere.radius;
    contact.force = sphere.force;
    resize_layers({places(), before}, {places(), contact.radius}, layers);
    move(glm::dvec2(0.0), 0.0);
  }
  void move(const glm::dvec2& slide, double spin) {
    contact.slide = slide;
    contact.spin = spin;
    last = move_layers(places(), mdr_tables().limit_curve, contact, layers);
  }
  [[nodiscard]] MdrPlaces places() const {
    return places_of(mdr_tables(), {.flat_share = contact.flat_share});
  }
  [[nodiscard]] double limit_force() const { return contact.friction * contact.force; }
  [[nodiscard]] double limit_couple() const {
    return limit_force() * contact.radius * reference::pure_spin_moment();
  }
  /// How far out on the exact limit surface the load lies.
  [[nodiscard]] double load() const {
    return reference::hertz_limit_load({glm::length(last.force) / limit_force(),
                                        std::abs(last.couple) / (limit_force() * contact.radius)});
  }
  [[nodiscard]] reference::LubkinContact lubkin(
      reference::PressureShape shape = reference::PressureShape::kHertz) const {
    return {shape, contact.force, contact.friction, contact.radius, contact.shear_modulus};
  }
  [[nodiscard]] reference::CattaneoMindlin mindlin() const {
    return {contact.force, contact.friction, contact.radius,
            4.0 * contact.shear_modulus / (2.0 - contact.poisson_ratio)};
  }
  /// Turn at which the couple would be the largest one without slip: the scale of all turns, rad.
  [[nodiscard]] double natural_turn() const {
    return reference::saturated_torque(lubkin()) / reference::torsional_stiffness(lubkin());
  }
  /// Likewise of displacements, m.
  [[nodiscard]] double natural_slide() const {
    return reference::full_slip_force(mindlin()) / reference::tangential_stiffness(mindlin());
  }

  MdrContact contact;
  MdrForces last;
  std::vector<MdrLayer> layers = std::vector<MdrLayer>(kMdrLayers);
};

}  // namespace torsion::engine::test
