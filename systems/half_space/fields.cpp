#include "systems/half_space/fields.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// A point relative to the half-space, and a wrench in parts. z is the depth below the plane.
struct Seen {
  glm::dvec3 inward;         // -normal: direction of z
  glm::dvec3 along;          // m, position in the plane, from the load
  double z;                  // m
  double distance;           // m, R
  double sum;                // m, R + z; where that is below 2R/5 bent to stay above R/5
  bool held;                 // whether it is
  double normal_force;       // N, along z
  glm::dvec3 tangent_force;  // N
  double torsion;            // N m, about z
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
  seen.torsion = glm::dot(wrench.torque, seen.inward);
  // arm x inward is the couple about the tangents
  seen.arm = glm::cross(seen.inward, wrench.torque);
  return seen;
}

/// Displacement times 4 pi G. With e inward, p along, k = 1 - 2 nu, s = R + z:
///   Boussinesq  (z/R^3 - k/(R s)) p + (z^2/R^3 + (1 + k)/R) e
///   Cerruti     (1/R + k/s) Q + (Q.p) [(1/R^3 - k/(R s^2)) p + (z/R^3 + k/(R s)) e]
///   torsion     e x p / R^3
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
         glm::cross(seen.inward, seen.along) * (seen.torsion * r3);
}

/// Half its curl times 4 pi G. The derivatives collapse to
///   Boussinesq  (1 + k) e x p / R^3
///   Cerruti     Q x p / R^3 + (z/R^3 + k/(R s)) Q x e + k (Q.p) (z + 2 R)/(R^3 s^2) e x p
///   torsion     (3 z (p + z e)/R^5 - e/R^3) / 2
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
         (offset * (3.0 * z * r5) - seen.inward * r3) * (0.5 * seen.torsion);
}

/// A third of the stress's trace, Pa: exact at nu = 0.5, where it does not follow from the
/// displacement. The dipole's is again minus the derivative along `arm`.
double mean_stress(const Seen& seen, const Elasticity& elasticity) {
  const double r1 = 1.0 / seen.distance;
  const double r3 = r1 * r1 * r1;
  return -(1.0 + elasticity.poisson_ratio) / (3.0 * pi) *
         ((seen.normal_force * seen.z + glm::dot(seen.tangent_force, seen.along)) * r3 +
          3.0 * glm::dot(seen.arm, seen.along) * seen.z * r3 * r1 * r1);
}

/// Gradient of scaled_displacement, column c the derivative along axis c, by the product rule.
glm::dmat3 scaled_gradient(const Seen& seen, double k) {
  const double z = seen.z;
  const double r1 = 1.0 / seen.distance;
  const double r2 = r1 * r1;
  const double r3 = r2 * r1;
  const double r4 = r2 * r2;
  const double r5 = r4 * r1;
  const double r6 = r3 * r3;
  const double s1 = 1.0 / seen.sum;
  const double s2 = s1 * s1;
  const glm::dvec3& e = seen.inward;
  const glm::dvec3& p = seen.along;
  const glm::dvec3& q = seen.tangent_force;
  // Gradients of R, and of s, which depends on R and z.
  const glm::dvec3 by_r = (p + z * e) * r1;
  const double share = 1.0 + z * r1;
  const glm::dvec3 by_s =
      seen.held ? by_r * (0.2 + (2.0 - share) * share / 0.8) + e * (share / 0.4) : by_r + e;

  const double spread = z * r3 - k * r1 * s1;
  const glm::dvec3 spread_by = e * r3 + by_r * (k * r2 * s1 - 3.0 * z * r4) + by_s * (k * r1 * s2);
  const glm::dvec3 sink_by = e * (2.0 * z * r3) - by_r * (3.0 * z * z * r4 + (1.0 + k) * r2);
  const glm::dvec3 shift_by = by_r * -r2 - by_s * (k * s2);  // of what multiplies Q
  const double tilt = r3 - k * r1 * s2;                      // multiplies (Q.p) p
  const glm::dvec3 tilt_by = by_r * (k * r2 * s2 - 3.0 * r4) + by_s * (2.0 * k * r1 * s2 * s1);
  const double dip = z * r3 + k * r1 * s1;  // multiplies (Q.p) e
  const glm::dvec3 dip_by = e * r3 - by_r * (3.0 * z * r4 + k * r2 * s1) - by_s * (k * r1 * s2);
  const double spread_slope = k * (s1 * r3 + s2 * r2) - 3.0 * z * r5;
  const glm::dvec3 spread_slope_by = e * (-3.0 * r5) +
                                     by_r * (15.0 * z * r6 - k * (3.0 * s1 * r4 + 2.0 * s2 * r3)) -
                                     by_s * (k * (s2 * r3 + 2.0 * s2 * s1 * r2));
  const double sink_slope = -3.0 * z * z * r5 - (1.0 + k) * r3;
  const glm::dvec3 sink_slope_by =
      e * (-6.0 * z * r5) + by_r * (15.0 * z * z * r6 + 3.0 * (1.0 + k) * r4);

  const double pull = glm::dot(q, p);
  const double lean = glm::dot(seen.arm, p);
  const double outward = seen.normal_force * spread + pull * tilt - lean * spread_slope;
  const glm::dvec3 outward_by = seen.normal_force * spread_by + tilt * q + pull * tilt_by -
                                spread_slope * seen.arm - lean * spread_slope_by;
  const glm::dvec3 inward_by = seen.normal_force * sink_by + dip * q + pull * dip_by -
                               sink_slope * seen.arm - lean * sink_slope_by;
  const glm::dvec3 turned = seen.torsion * r3 * e;
  glm::dmat3 gradient = glm::outerProduct(q, shift_by) - glm::outerProduct(seen.arm, spread_by) +
                        glm::outerProduct(p, outward_by) +
                        glm::outerProduct(e, inward_by - outward * e) +
                        glm::outerProduct(glm::cross(turned, p), by_r * (-3.0 * r1));
  for (int c = 0; c < 3; ++c) {
    glm::dvec3 axis(0.0);
    axis[c] = 1.0;
    gradient[c] += outward * axis + glm::cross(turned, axis);
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
    const glm::dmat3 g = scaled_gradient(seen, k);
    rotation = 0.5 * glm::dvec3(g[1][2] - g[2][1], g[2][0] - g[0][2], g[0][1] - g[1][0]);
  } else {
    rotation = scaled_rotation(seen, k);
  }
  return {scale * scaled_displacement(seen, k), scale * rotation};
}

glm::dmat3 half_space_gradient(const Port& load, const Elasticity& elasticity, const Wrench& wrench,
                               const glm::dvec3& point) {
  return scaled_gradient(seen_from(load, wrench, point), 1.0 - 2.0 * elasticity.poisson_ratio) /
         (4.0 * pi * elasticity.shear_modulus());
}

glm::dmat3 half_space_stress(const Port& load, const Elasticity& elasticity, const Wrench& wrench,
                             const glm::dvec3& point) {
  const double k = 1.0 - 2.0 * elasticity.poisson_ratio;
  if (k == 0.0 && wrench.torque == glm::dvec3(0.0)) {
    // Boussinesq's and Cerruti's stress in an incompressible material acts along the ray alone.
    const glm::dvec3 ray = point - load.position;
    const double square = glm::dot(ray, ray);
    return glm::outerProduct(ray, ray) *
           (-1.5 / pi * glm::dot(wrench.force, ray) / (square * square * std::sqrt(square)));
  }
  const Seen seen = seen_from(load, wrench, point);
  const glm::dmat3 gradient = scaled_gradient(seen, k);
  glm::dmat3 stress = (gradient + glm::transpose(gradient)) * (1.0 / (4.0 * pi));
  const double excess =
      mean_stress(seen, elasticity) - (stress[0][0] + stress[1][1] + stress[2][2]) / 3.0;
  for (int c = 0; c < 3; ++c) {
    stress[c][c] += excess;
  }
  return stress;
}

Wrench unit_wrench(int column) {
  Wrench wrench;
  (column < 3 ? wrench.force : wrench.torque)[column % 3] = 1.0;
  return wrench;
}

Matrix6 half_space_response(const Port& to, const Port& from, const Elasticity& elasticity) {
  Matrix6 response;
  for (int column = 0; column < 6; ++column) {
    const MaterialMotion motion =
        half_space_motion(from, elasticity, unit_wrench(column), to.position);
    for (int axis = 0; axis < 3; ++axis) {
      response(axis, column) = motion.displacement[axis];
      response(3 + axis, column) = motion.rotation[axis];
    }
  }
  return response;
}

Matrix6 half_space_coupling(const Port& to, const Port& from, const Elasticity& elasticity) {
  return 0.5 * (half_space_response(to, from, elasticity) +
                half_space_response(from, to, elasticity).transpose());
}

}  // namespace torsion::engine
