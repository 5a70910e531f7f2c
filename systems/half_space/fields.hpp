#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion {

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

}  // namespace torsion
