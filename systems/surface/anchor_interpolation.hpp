#pragma once

// From displacements of a few anchors to a displacement everywhere: the biharmonic spline
//   u(x) = sum over j of w_j |x - x_j| + c + C x,
// which has the least bending energy of all fields through the anchors and reproduces every affine
// field (docs/models.md, "From anchors to vertices").

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/frame_world.hpp"
#include "systems/surface/twist_and_dent.hpp"

namespace torsion::engine {

/// The matrix that turns displacements at `centers` (and four zeros) into the weights w and the
/// affine part: row-major, (n + 4)^2 values, unit 1 or 1/m. Load time only. Empty with fewer than
/// five centers.
std::vector<InterpolationRow> invert_interpolation(std::span<const glm::dvec3> centers);

/// Weights of one field, laid out for loops over many points.
struct InterpolationWeights {
  struct Center {
    glm::vec3 position{0.0F};  // m, body
    glm::vec3 weight{0.0F};    // m per m
  };
  std::vector<Center> centers;
  glm::dvec3 constant{0.0};                                                   // m, at `origin`
  glm::dvec3 slope[3] = {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};  // m per m of x, y, z
};

/// @param inverse  what invert_interpolation gave for `centers`
/// @param values   m, one for each center
void solve_interpolation(std::span<const InterpolationRow> inverse,
                         std::span<const glm::dvec3> centers, std::span<const glm::dvec3> values,
                         InterpolationWeights& weights);

/// Weights of a field of numbers, for instance angles, over the same centers.
struct ScalarWeights {
  std::vector<float> weights;  // per m
  double constant = 0.0;
  glm::dvec3 slope{0.0};  // per m
};

/// @param values  one for each center
void solve_interpolation(std::span<const InterpolationRow> inverse, std::span<const double> values,
                         ScalarWeights& weights);

/// The field of numbers at one point.
double interpolate(const ScalarWeights& weights, std::span<const glm::dvec3> centers,
                   const glm::dvec3& point);

/// The field at one point [m].
glm::dvec3 interpolate(const InterpolationWeights& weights, const glm::dvec3& point);

/// A field of numbers and where its values at the points of a block go.
struct ScalarColumn {
  const ScalarWeights* weights = nullptr;
  BlockColumn* values = nullptr;
};

/// The field and the fields of numbers over the same centers at all points of the block, in float:
/// 1e-6 of the largest value.
void interpolate_block(const InterpolationWeights& weights, const BlockVectors& points,
                       BlockVectors& field, std::span<const ScalarColumn> columns);

}  // namespace torsion::engine
