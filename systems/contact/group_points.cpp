#include "systems/contact/group_points.hpp"

#include <algorithm>
#include <numeric>

#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/disjoint_sets.hpp"

namespace torsion::engine {
namespace {

/// Links pairs that are closer than `threshold`, until all points are one group.
/// @return how many groups are left
std::uint32_t link_near(std::span<const glm::dvec3> points, std::span<const NearPair> near,
                        double threshold, std::span<std::uint32_t> parent) {
  auto left = static_cast<std::uint32_t>(points.size());
  for (const NearPair& pair : near) {
    if (parent[pair.first] == parent[pair.second]) {
      continue;
    }
    const glm::dvec3 gap = points[pair.second] - points[pair.first];
    if (glm::dot(gap, gap) < threshold * threshold && link(parent, pair.first, pair.second) &&
        --left == 1) {
      break;
    }
  }
  return left;
}

int longest_axis(std::span<const glm::dvec3> points) {
  glm::dvec3 lowest = points[0];
  glm::dvec3 highest = points[0];
  for (const glm::dvec3& point : points) {
    lowest = glm::min(lowest, point);
    highest = glm::max(highest, point);
  }
  const glm::dvec3 size = highest - lowest;
  if (size.x >= size.y && size.x >= size.z) {
    return 0;
  }
  return size.y >= size.z ? 1 : 2;
}

/// Links all pairs closer than `threshold`: sorted along the longest axis, only points within
/// `threshold` along it can be.
void link_by_sweep(std::span<const glm::dvec3> points, double threshold,
                   std::span<std::uint32_t> sorted, std::span<std::uint32_t> parent) {
  std::iota(sorted.begin(), sorted.end(), 0U);
  const int axis = longest_axis(points);
  std::ranges::sort(sorted, [&](std::uint32_t a, std::uint32_t b) {
    return points[a][axis] < points[b][axis] || (points[a][axis] == points[b][axis] && a < b);
  });
  for (std::size_t first = 0; first < sorted.size(); ++first) {
    const glm::dvec3& point = points[sorted[first]];
    for (std::size_t second = first + 1; second < sorted.size(); ++second) {
      const glm::dvec3 gap = points[sorted[second]] - point;
      if (gap[axis] >= threshold) {
        break;
      }
      if (glm::dot(gap, gap) < threshold * threshold) {
        link(parent, sorted[first], sorted[second]);
      }
    }
  }
}

/// @return the number of groups that the links make
std::uint32_t number_groups(std::span<std::uint32_t> parent, std::uint32_t count,
                            std::span<std::uint32_t> groups) {
  std::uint32_t group_count = 0;
  for (std::uint32_t point = 0; point < count; ++point) {
    const std::uint32_t root = root_of(parent, point);
    groups[point] = root == point ? group_count++ : groups[root];
  }
  return group_count;
}

}  // namespace

std::uint32_t group_points(std::span<const glm::dvec3> points, std::span<const NearPair> near,
                           double threshold, std::span<std::uint32_t> order,
                           std::span<std::uint32_t> parent, std::span<std::uint32_t> groups) {
  const auto count = static_cast<std::uint32_t>(points.size());
  if (count == 0) {
    return 0;
  }
  TORSION_ASSERT(order.size() >= count && parent.size() >= count && groups.size() >= count);
  std::iota(parent.begin(), parent.begin() + count, 0U);
  if (link_near(points, near, threshold, parent) == 1) {
    std::ranges::fill(groups.first(count), 0U);
    return 1;
  }
  link_by_sweep(points, threshold, order.first(count), parent);
  return number_groups(parent, count, groups);
}

void group_contact_points(StepContext& context) {
  ContactScratch& scratch = context.scratch;
  for (ContactPair& pair : scratch.pairs) {
    const std::span<ContactPoint> points(scratch.points.data() + pair.points.first,
                                         pair.points.count);
    scratch.cluster_points.clear();
    for (const ContactPoint& point : points) {
      scratch.cluster_points.push_back(point.position);
    }
    const std::span<std::uint32_t> order(scratch.order);
    const std::span<std::uint32_t> groups = order.subspan(order.size() / 2);
    const double threshold = context.model.bodies.at<BodyModels>(pair.body).region_threshold;
    const std::span<const NearPair> near(scratch.near_pairs.data() + pair.near.first,
                                         pair.near.count);
    pair.clusters = group_points(scratch.cluster_points, near, threshold,
                                 order.first(order.size() / 2), scratch.parent, groups);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].cluster = groups[i];
    }
  }
}

}  // namespace torsion::engine
