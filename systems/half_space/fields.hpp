#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {

/// An elastic half-space under its surface; the surface goes through where a force acts.
struct HalfSpace {
  glm::dvec3 normal{0.0};      // unit, outward
  double shear_modulus = 0.0;  // G, Pa
  double poisson_ratio = 0.0;  // nu
};

/// Displacement [m] by a force on the surface that is spread over a width: Boussinesq's and
/// Cerruti's solutions with the distance R replaced by sqrt(R^2 + spread^2), so that it is finite
/// at the force and exact far from it. A point above the surface counts as on it.
/// @param away   m: from the force to the point
/// @param force  N, on the material
/// Source: Johnson, Contact Mechanics (1985), eq. 3.18 and 3.75.
inline glm::dvec3 displacement_by_force(const HalfSpace& half_space, const glm::dvec3& away,
                                        const glm::dvec3& force, double spread) {
  const double height = glm::dot(away, half_space.normal);
  const double z = std::max(-height, 0.0);  // depth
  const glm::dvec3 across = away - half_space.normal * height;
  const double r = std::sqrt(glm::dot(across, across) + z * z + spread * spread);
  const double inverse = 1.0 / r;
  const double cube = inverse * inverse * inverse;
  const double free = 1.0 - 2.0 * half_space.poisson_ratio;
  const double sum = 1.0 / (r + z);
  const double pressing = -glm::dot(force, half_space.normal);
  const glm::dvec3 drag = force + half_space.normal * pressing;
  const double along = glm::dot(drag, across);
  // Boussinesq, then Cerruti; positive depth is against the normal.
  const glm::dvec3 lateral = across * (pressing * (z * cube - free * inverse * sum) +
                                       along * (cube - free * inverse * sum * sum)) +
                             drag * (inverse + free * sum);
  const double down = pressing * (z * z * cube + 2.0 * (1.0 - half_space.poisson_ratio) * inverse) +
                      along * (z * cube + free * inverse * sum);
  return (lateral - half_space.normal * down) / (4.0 * std::numbers::pi * half_space.shear_modulus);
}

/// A point of a body's surface at which a wrench acts, with the outward normal there.
struct Port {
  glm::dvec3 position{0.0};          // m, body
  glm::dvec3 normal{0.0, 0.0, 1.0};  // body, unit, out of the body
};

/// How the material at a point has moved.
struct MaterialMotion {
  glm::dvec3 displacement{0.0};  // m, body
  glm::dvec3 rotation{0.0};      // rad, body: half the curl of the displacement
};

/// What a wrench on the surface of the elastic half-space {x : (x - load.position) . normal <= 0}
/// does to the material at `point`, in closed form: force as Boussinesq and Cerruti have it, couple
/// about the normal as Reissner and Sagoci's far field, couples about the tangents as the dipole of
/// normal forces. Tends to infinity towards load.position, where it must not be asked for.
///
/// A point above the plane (a concave body has some) gets the same formulas continued; the lines
/// R + z in them, which would vanish straight above the load, are bent from 2R/5 on so as to stay
/// above R/5: there, and only for nu < 0.5, the field is smooth but no solution any more.
/// @param load     where the wrench acts
/// @param wrench   on the material: force (N) and torque about load.position (N m), body axes
/// @param point    m, body, not load.position
/// Source: Johnson, Contact Mechanics (1985), eq. 3.18-3.19 (Boussinesq) and 3.75 (Cerruti).
MaterialMotion half_space_motion(const Port& load, const Elasticity& elasticity,
                                 const Wrench& wrench, const glm::dvec3& point);

/// Gradient of the displacement, column c the derivative along axis c.
glm::dmat3 half_space_gradient(const Port& load, const Elasticity& elasticity, const Wrench& wrench,
                               const glm::dvec3& point);

/// Stress (symmetric, Pa, body axes) of the same field: its deviator from the gradient, its mean
/// (tension positive) in closed form, exact at nu = 0.5, where it does not follow from the
/// displacement. The traction on a surface with outward normal n is stress * n.
glm::dmat3 half_space_stress(const Port& load, const Elasticity& elasticity, const Wrench& wrench,
                             const glm::dvec3& point);

// What wrenches on the surface of a half-space do elsewhere.

/// A unit force along, or torque about, a body axis.
/// @param column  0 to 5: of forces, then of torques
Wrench unit_wrench(int column);

/// Motion at `to` under unit wrenches at `from`, through from's half-space.
Matrix6 half_space_response(const Port& to, const Port& from, const Elasticity& elasticity);

/// Motion (translation, rotation) of the material at `to` under a wrench (force, torque) at `from`
/// as far as half-spaces have it: the mean of the field of from's half-space at `to` and, by
/// reciprocity, of to's at `from`. The two are the same on one plane, and for forces at nu = 0.5.
/// @param to, from  not at one place
Matrix6 half_space_coupling(const Port& to, const Port& from, const Elasticity& elasticity);

}  // namespace torsion::engine
