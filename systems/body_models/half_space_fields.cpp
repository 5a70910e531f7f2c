#include "systems/body_models/half_space_fields.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace torsion {
namespace {

using std::numbers::pi;

/// A point as the half-space sees it, and a wrench in parts. z is the depth below the plane.
struct Seen {
  glm::dvec3 inward;         // -normal: direction of z
  glm::dvec3 along;          // m, position in the plane, from the load
  double z;                  // m
  double distance;           // m, R
  double sum;                // m, R + z; where that is below 2R/5 bent to stay above R/5
  bool held;                 // whether it is
  double normal_force;       // N, along z
  glm::dvec3 tangent_force;  // N
  double twist;              // N m, about z
  glm::dvec3 arm;            // N m: a dipole (force along z, at +arm less at -arm) is the couple
};

Seen seen_from(const Port& load, const Wrench& wrench, const glm::dvec3& point) {
  Seen seen{};
  seen.inward = -load.normal;
  const glm::dvec3 offset = point - load.position;
  seen.z = glm::dot(offset, seen.inward);
  seen.along = offset - seen.z * seen.inward;
  seen.distance = glm::length(offset);
  const double share = (seen.distance + seen.z) / seen.distance;
  seen.held = share < 0.4;
  seen.sum = seen.distance * (seen.held ? 0.2 + share * share / 0.8 : share);
  seen.normal_force = glm::dot(wrench.force, seen.inward);
  seen.tangent_force = wrench.force - seen.normal_force * seen.inward;
  seen.twist = glm::dot(wrench.torque, seen.inward);
  // arm x inward is the couple about the tangents
  seen.arm = glm::cross(seen.inward, wrench.torque);
  return seen;
}

/// Displacement times 4 pi G. With e inward, p along, k = 1 - 2 nu, s = R + z:
///   Boussinesq  (z/R^3 - k/(R s)) p + (z^2/R^3 + (1 + k)/R) e
///   Cerruti     (1/R + k/s) Q + (Q.p) [(1/R^3 - k/(R s^2)) p + (z/R^3 + k/(R s)) e]
///   twist       e x p / R^3
///   dipole      minus the derivative of Boussinesq's along `arm`
glm::dvec3 scaled_displacement(const Seen& seen, double k) {
  const double r1 = 1.0 / seen.distance;
  const double r3 = r1 * r1 * r1;
  const double r5 = r3 * r1 * r1;
  const double s1 = 1.0 / seen.sum;
  const double z = seen.z;
  const double spread = z * r3 - k * r1 * s1;
  const double sink = z * z * r3 + (1.0 + k) * r1;
  const double pull = glm::dot(seen.tangent_force, seen.along);
  const double lean = glm::dot(seen.arm, seen.along);
  const double spread_slope = lean * (-3.0 * z * r5 + k * s1 * r1 * r1 * (r1 + s1));
  const double sink_slope = lean * (-3.0 * z * z * r5 - (1.0 + k) * r3);
  return seen.tangent_force * (r1 + k * s1) - seen.arm * spread +
         seen.along * (seen.normal_force * spread + pull * (r3 - k * r1 * s1 * s1) - spread_slope) +
         seen.inward * (seen.normal_force * sink + pull * (z * r3 + k * r1 * s1) - sink_slope) +
         glm::cross(seen.inward, seen.along) * (seen.twist * r3);
}

/// Half its curl times 4 pi G; the derivatives collapse to
///   Boussinesq  (1 + k) e x p / R^3
///   Cerruti     Q x p / R^3 + (z/R^3 + k/(R s)) Q x e + k (Q.p) (z + 2 R)/(R^3 s^2) e x p
///   twist       (3 z (p + z e)/R^5 - e/R^3) / 2
glm::dvec3 scaled_rotation(const Seen& seen, double k) {
  const double r1 = 1.0 / seen.distance;
  const double r3 = r1 * r1 * r1;
  const double r5 = r3 * r1 * r1;
  const double s1 = 1.0 / seen.sum;
  const double z = seen.z;
  const double pull = glm::dot(seen.tangent_force, seen.along);
  const double lean = glm::dot(seen.arm, seen.along);
  const glm::dvec3 around = glm::cross(seen.inward, seen.along);
  const glm::dvec3 offset = seen.along + z * seen.inward;
  return around * ((1.0 + k) * (seen.normal_force * r3 + 3.0 * lean * r5) +
                   k * pull * (z + 2.0 * seen.distance) * r3 * s1 * s1) -
         glm::cross(seen.inward, seen.arm) * ((1.0 + k) * r3) +
         glm::cross(seen.tangent_force, seen.along) * r3 +
         glm::cross(seen.tangent_force, seen.inward) * (z * r3 + k * r1 * s1) +
         (offset * (3.0 * z * r5) - seen.inward * r3) * (0.5 * seen.twist);
}

/// Trace of the stress over -(1 + nu)/pi; the dipole again by minus the derivative along `arm`.
double scaled_trace(const Seen& seen) {
  const double r1 = 1.0 / seen.distance;
  const double r3 = r1 * r1 * r1;
  return (seen.normal_force * seen.z + glm::dot(seen.tangent_force, seen.along)) * r3 +
         3.0 * glm::dot(seen.arm, seen.along) * seen.z * r3 * r1 * r1;
}

/// Gradient of scaled_displacement by central differences, column c the derivative along axis c.
/// Truncation grows with the step's square, rounding falls with the step: 2e-4 R leaves 1e-6 and
/// 1e-12 of the gradient.
glm::dmat3 scaled_gradient(const Port& load, const Wrench& wrench, const glm::dvec3& point,
                           double k) {
  const double step = 2e-4 * glm::distance(point, load.position);
  glm::dmat3 gradient(0.0);
  for (int c = 0; c < 3; ++c) {
    glm::dvec3 shift(0.0);
    shift[c] = step;
    gradient[c] = (scaled_displacement(seen_from(load, wrench, point + shift), k) -
                   scaled_displacement(seen_from(load, wrench, point - shift), k)) /
                  (2.0 * step);
  }
  return gradient;
}

}  // namespace

MaterialMotion half_space_motion(const Port& load, const Elasticity& elasticity,
                                 const Wrench& wrench, const glm::dvec3& point) {
  const Seen seen = seen_from(load, wrench, point);
  const double scale = 1.0 / (4.0 * pi * elasticity.shear_modulus());
  const double k = 1.0 - 2.0 * elasticity.poisson_ratio;
  glm::dvec3 rotation(0.0);
  if (seen.held && k != 0.0) {  // the closed form is not the curl there
    const glm::dmat3 g = scaled_gradient(load, wrench, point, k);
    rotation = 0.5 * glm::dvec3(g[1][2] - g[2][1], g[2][0] - g[0][2], g[0][1] - g[1][0]);
  } else {
    rotation = scaled_rotation(seen, k);
  }
  return {scale * scaled_displacement(seen, k), scale * rotation};
}

double half_space_mean_stress(const Port& load, const Elasticity& elasticity, const Wrench& wrench,
                              const glm::dvec3& point) {
  return -(1.0 + elasticity.poisson_ratio) / (3.0 * pi) *
         scaled_trace(seen_from(load, wrench, point));
}

glm::dmat3 half_space_stress(const Port& load, const Elasticity& elasticity, const Wrench& wrench,
                             const glm::dvec3& point) {
  const double k = 1.0 - 2.0 * elasticity.poisson_ratio;
  if (k == 0.0 && wrench.torque == glm::dvec3(0.0)) {
    // Boussinesq's and Cerruti's stress of an incompressible material: all along the ray.
    const glm::dvec3 ray = point - load.position;
    const double square = glm::dot(ray, ray);
    return glm::outerProduct(ray, ray) *
           (-1.5 / pi * glm::dot(wrench.force, ray) / (square * square * std::sqrt(square)));
  }
  const glm::dmat3 gradient = scaled_gradient(load, wrench, point, k);
  glm::dmat3 stress = (gradient + glm::transpose(gradient)) * (1.0 / (4.0 * pi));
  const double excess = half_space_mean_stress(load, elasticity, wrench, point) -
                        (stress[0][0] + stress[1][1] + stress[2][2]) / 3.0;
  for (int c = 0; c < 3; ++c) {
    stress[c][c] += excess;
  }
  return stress;
}

}  // namespace torsion
