#pragma once

// How a point force on a gently curved body displaces the surface beyond what it would do to a
// half-space: the first term in the surface's curvature.

#include <array>
#include <cstddef>
#include <span>

#include <glm/vec2.hpp>

#include "systems/half_space/influence.hpp"

namespace torsion::engine {

/// How a surface bends away from its tangent plane: (xx x^2 + 2 xy x y + yy y^2) / 2 below it.
struct SurfaceCurvature {
  double xx = 0.0;  // 1/m
  double xy = 0.0;
  double yy = 0.0;
};

/// The kinds that curvature changes in its first order: kZZ, kXX, kXY, kYY. It couples pressure and
/// sideways motion, too, by shares of curvature times size that change their sign across the
/// contact; those are left out.
inline constexpr std::size_t kCurvedKinds = 4;

/// A displacement times 8 pi G over the force, 1/m: steady + cos_2 cos 2t + sin_2 sin 2t +
/// cos_4 cos 4t + sin_4 sin 4t - log ln r at the distance r and the angle t from x.
struct CurvedKind {
  double log = 0.0;
  double steady = 0.0;
  double cos_2 = 0.0;
  double sin_2 = 0.0;
  double cos_4 = 0.0;
  double sin_4 = 0.0;
};
using CurvedResponse = std::array<CurvedKind, kCurvedKinds>;

/// On the tangent plane z = 0 the half-space's field leaves the true surface, h below the plane,
/// with tractions d(h s_ab)/dx_a, s its stresses there (Johnson, Contact Mechanics, 1985, (3.19),
/// (3.75)). They are taken off by the half-space's own response, and h times the field's slope down
/// is added. All of it is r^0 or ln r times waves of the angle, whose Fourier transforms are known;
/// curved_influence_test.cpp goes the whole way in numbers. On a sphere of radius R motion across a
/// wave of number k gets 3 / (2 G R k^2), which the exact twists R / (G (n - 1)) say too, k = (n +
/// 1/2) / R (Love, Theory of Elasticity, 1927, 182).
CurvedResponse curved_response(const SurfaceCurvature& curvature, double poisson_ratio);

/// Times 8 pi G over the force, 1/m.
/// @param offset  m, from the force
/// @param reach   m: distance at which the logarithm is zero
double curved_displacement(const CurvedKind& kind, const glm::dvec2& offset, double reach);

/// Likewise, of a force that is spread over a disc as a rigid one spreads it: its mean there, with
/// the same weights.
/// @param radius  m
double curved_mean(const CurvedKind& kind, double radius, double reach);

/// Tables for a grid on a curved surface: the half-space's and what the curvature adds.
/// @param cell    m
/// @param reach   m: distance at which the logarithm is zero
/// @param values  (layer_influence_count(side)) out
void fill_curved_influences(const InfluenceTables& half_space, const CurvedResponse& response,
                            const glm::dvec2& cell, double reach, std::span<double> values);

}  // namespace torsion::engine
