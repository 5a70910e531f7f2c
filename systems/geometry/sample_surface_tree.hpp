#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ecs/components.hpp"

namespace torsion {

/// A tree of balls over points, depth first, without radii: 4 branches a node down to nodes of at
/// most 8 leaves. `order` says which point each leaf is, in the order of the leaves. Leaf i has
/// sample = i.
struct PointTree {
  std::vector<SurfaceBall> balls;
  std::vector<std::uint32_t> order;  // row of `points` for leaf 0, 1, 2, ...
};

/// Cuts the points at the median of the longest side of their box, twice for each node.
PointTree point_tree(std::span<const glm::dvec3> points);

/// Sets the inner balls so that each holds the leaf balls below it.
void fit_balls(std::span<SurfaceBall> balls);

/// The leaf whose centre is nearest to `point`. @param hint  a leaf that is perhaps near
std::uint32_t nearest_leaf(std::span<const SurfaceBall> balls,
                           std::span<const glm::dvec3> leaf_centers, const glm::dvec3& point,
                           std::uint32_t hint);

}  // namespace torsion
