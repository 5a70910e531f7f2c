#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "systems/geometry/distance.hpp"
#include "systems/geometry/distance_cell.hpp"

namespace torsion::engine {

/// The distance in a cell with a crease: to the outermost of planes that meet at convex edges, or
/// to the innermost of planes that meet at concave ones. In a solid that is the overlap of
/// half-spaces the distance to it is the largest of those to their planes; beside one whose
/// complement is such an overlap, the smallest.
/// @param planes   the crease's; not empty
/// @param offset   m, from the cell's lowest corner
/// @return         gradient (unitless), and the distance (m) as w
glm::vec4 distance_at_crease(std::span<const DistanceNode> planes, const glm::vec3& offset,
                             bool concave);

/// Whether a cell is at the surface or below it, and the normals of its corners differ by so much
/// that it may hold a sharp edge.
/// @param spacing  m
bool may_have_crease(const CellNodes& nodes, double spacing);

/// Where a cell's crease is fitted: 4 x 4 x 4 places, its corners and faces among them.
inline constexpr std::size_t kCreaseSamples = 64;

/// 0 to 1 along each axis, within the cell.
std::array<double, 3> crease_sample(std::size_t sample);

/// The planes of one cell, and of which kind its edges are.
struct CreaseFit {
  std::vector<DistanceNode> planes;  // empty where the smooth blend comes closer
  bool concave = false;
};

/// The crease with which a cell comes closest to its samples in the least squares. What bends by
/// its curvature alone is followed better by the smooth blend than by planes, and so is a corner at
/// which convex and concave edges meet.
/// @param spacing  m
/// @param exact    at the samples
CreaseFit fit_crease(const CellNodes& nodes, double spacing,
                     const std::array<Distance, kCreaseSamples>& exact);

}  // namespace torsion::engine
