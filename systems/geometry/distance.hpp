#pragma once

#include <span>

#include "ecs/model.hpp"

namespace torsion::engine {

/// Signed distance (negative inside) and its gradient.
struct Distance {
  double value = 0.0;        // m
  glm::dvec3 gradient{0.0};  // unit in exact arithmetic; nearly so for mesh fields
};

/// Signed distance from `point` to the union of `parts`, and its gradient. Exact outside and on the
/// surface for sphere, box, cylinder and capsule; for an ellipsoid exact on the surface and correct
/// to first order near it; for a mesh as accurate as its field
/// (systems/geometry/distance_field.hpp). Never overestimates |distance| by more than a mesh
/// field's error.
/// @param point  m, the owner's frame
Distance signed_distance(const Model& model, Range parts, const glm::dvec3& point);

/// Which of `parts` can be the nearest to any point within `reach` [m] of `center`.
/// @param rows  at least parts.count long; its front is filled
/// @return the filled front: rows of Model::parts, rising; not empty unless `parts` is
std::span<const std::uint32_t> parts_near(const Model& model, Range parts, const glm::dvec3& center,
                                          double reach, std::span<std::uint32_t> rows);

/// Columns of one length: points, and what is found there.
struct DistanceColumns {
  std::span<double> x, y, z;                             // m
  std::span<double> value;                               // m
  std::span<double> gradient_x, gradient_y, gradient_z;  // unit
};

/// The same as signed_distance for many points and the parts in `rows` of Model::parts, in another
/// frame: a step's hot loop.
/// @param frame    the frame of points and gradients, in the owner's
/// @param columns  in: x, y, z; out: the rest
void signed_distances(const Model& model, std::span<const std::uint32_t> rows, const Pose& frame,
                      const DistanceColumns& columns);

/// Columns of one length, m.
struct PointColumns {
  std::span<const double> x, y, z;
};

/// The same for all of `parts` without the gradients.
/// @param frame   the frame of the points, in the owner's
/// @param values  m, (n) out
void distance_values(const Model& model, Range parts, const Pose& frame, const PointColumns& points,
                     std::span<double> values);

}  // namespace torsion::engine
