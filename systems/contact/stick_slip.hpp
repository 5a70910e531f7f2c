#pragma once

// How friction goes over from static to dynamic and back: by paths travelled, not by time, so that
// the outcome does not depend on the step.

#include <cstdint>

#include "ecs/state.hpp"

namespace torsion::engine {

/// A cell that slips comes down from mu_s to mu_d over this share of its elastic deflection: short
/// enough to be the paper's switch (4) -> (5) within the accuracy of 200 cells, long enough that
/// the force does not jump.
inline constexpr double kSlipLength = 0.05;

/// (exp(x) - 1) / x to third order in x: the reciprocal of the exponential's series makes a decay
/// that is monotone, within 4e-6 of exp(-x) up to a tenth, and the same bits with every mathematics
/// library.
inline double growth(double x) {
  return 1.0 + x * (0.5 + x * (1.0 / 6.0));
}

/// 1 - exp(-path / scale): approaches 1 as `path` is travelled.
inline double travelled(double path, double inverse_scale) {
  const double x = path * inverse_scale;
  const double grown = x * growth(x);
  return grown / (1.0 + grown);
}

/// 1 / scale, with 1 / 0 so large that any path is the whole way and none is none.
inline double inverse_of(double scale) {
  return scale > 0.0 ? 1.0 / scale : 1e60;
}

/// How a region resists small motions of its tool, about the region's point and along its frame.
struct StuckStiffness {
  double along_tangents = 0.0;     // N/m
  double along_normal = 0.0;       // N/m
  glm::dvec2 about_tangents{0.0};  // N m/rad: about tangent_x, tangent_y
  double about_normal = 0.0;       // N m/rad
};

/// Of a region that sticks everywhere: of a rigid ellipse bonded to a half-space, with the
/// overlap's axes. It is for Newton's method, which overshoots where a stiffness is half of what it
/// should be: the motions of tool and body would then feed each other. Source:
/// elliptic_contact.hpp; Johnson, 1985, 3.2 and 3.7, for the tilt of a disc.
///
/// A long contact resists tilting more, because its force moves along it. A tilt by t moves the
/// apex of a paraboloid of curvature k, and the force F with it, by t / k. Its overlap reaches
/// h = sqrt(2 d / k) from the apex, d deep there, so F t / k = F t h^2 / (2 d); for a ball this is
/// the bonded disc's. A flat contact's force goes to t 2 h^2 / (3 d) (mdr/round_contact.hpp).
/// Between the two: 0.6.
/// @param radius  m, of the disc of equal area
StuckStiffness stuck_stiffness(const Model& model, const State& state, std::uint32_t region,
                               double radius);

}  // namespace torsion::engine
