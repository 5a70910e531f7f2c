#pragma once

// The smooth piece of an exact shape's surface around a point: how it curves there, how far it
// drops away from its tangent plane, and where it ends.

#include <array>
#include <cstdint>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion::engine {

/// Where a piece ends: it covers the points x with direction . (x - point) <= distance.
struct PieceBorder {
  glm::dvec3 direction{0.0};  // unit
  double distance = 0.0;      // m, from the point that the piece was asked for
};

/// Points x with sum quadric_i (x_i - center_i)^2 = 1, or a plane where `quadric` is zero. In the
/// part's frame.
struct SurfacePiece {
  glm::dvec3 quadric{0.0};  // 1/m^2
  glm::dvec3 center{0.0};   // m
  glm::dvec3 face{0.0};     // unit outward normal of a plane
  std::array<PieceBorder, 4> border_list{};
  std::uint32_t borders = 0;

  [[nodiscard]] std::span<const PieceBorder> ends() const { return {border_list.data(), borders}; }
};

/// The piece of the part's surface that `point` [m, part frame] lies on or near. @pre part.kind is
/// not kMesh
SurfacePiece piece_at(const ShapePart& part, const glm::dvec3& point);

/// Curvature of the surface at `point` on it, 1/m: how its unit normal changes along it. Symmetric;
/// along the normal it is zero.
glm::dmat3 curvature_at(const SurfacePiece& piece, const glm::dvec3& point);

/// How far below the tangent plane at `point` the surface lies, `aside` [m] from it along the
/// plane; NaN where there is none. Positive where the surface is convex.
/// @param point   m, on the surface
/// @param normal  unit, outward there
double drop_at(const SurfacePiece& piece, const glm::dvec3& point, const glm::dvec3& normal,
               const glm::dvec3& aside);

}  // namespace torsion::engine
