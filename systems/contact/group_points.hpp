#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// For each pair, numbers the groups of points closer than r_th: the paper's contact regions of
/// this step.
void group_contact_points(StepContext& context);

/// Links between points, as disjoint sets of their rows.
struct PointLinks {
  std::span<std::uint32_t> parent;  // (n)
  std::uint32_t sets = 0;           // how many there are
};

/// No links: each point is by itself.
/// @param parent  (n) scratch
PointLinks no_links(std::span<std::uint32_t> parent);

/// Single-linkage groups (section II.A of the paper): two points share a group if a chain of points
/// leads from one to the other with every link shorter than `threshold`. Groups are numbered in the
/// order of their first point.
/// @param points     (n) m
/// @param threshold  r_th, m, > 0
/// @param links      in: those that are known, each shorter than the threshold: where they join all
///                   points into one group, no other pair is looked at; out: of no use
/// @param order      (at least n) scratch
/// @param groups     (n) out: group of each point
/// @return number of groups
/// O(n log n) plus the pairs closer than `threshold` along the longest axis. Allocates nothing.
std::uint32_t group_points(std::span<const glm::dvec3> points, double threshold,
                           const PointLinks& links, std::span<std::uint32_t> order,
                           std::span<std::uint32_t> groups);

}  // namespace torsion::engine
