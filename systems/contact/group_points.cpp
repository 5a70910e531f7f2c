#include "systems/contact/group_points.hpp"

#include <algorithm>
#include <numeric>

#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/disjoint_sets.hpp"

namespace torsion::engine {
namespace {

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

PointLinks no_links(std::span<std::uint32_t> parent) {
  std::iota(parent.begin(), parent.end(), 0U);
  return {parent, static_cast<std::uint32_t>(parent.size())};
}

std::uint32_t group_points(std::span<const glm::dvec3> points, double threshold,
                           const PointLinks& links, std::span<std::uint32_t> order,
                           std::span<std::uint32_t> groups) {
  const auto count = static_cast<std::uint32_t>(points.size());
  TORSION_ASSERT(order.size() >= count && links.parent.size() == count && groups.size() >= count);
  if (links.sets <= 1) {
    std::ranges::fill(groups.first(count), 0U);
    return links.sets;
  }
  link_by_sweep(points, threshold, order.first(count), links.parent);
  return number_groups(links.parent, count, groups);
}

void group_contact_points(StepContext& context) {
  ContactScratch& scratch = context.scratch;
  for (ContactPair& pair : scratch.pairs) {
    if (pair.clusters <= 1) {
      continue;  // all points are of cluster 0 already
    }
    const std::span<ContactPoint> points(scratch.points.data() + pair.points.first,
                                         pair.points.count);
    scratch.cluster_points.clear();
    for (const ContactPoint& point : points) {
      scratch.cluster_points.push_back(point.position);
    }
    const std::span<std::uint32_t> order(scratch.order);
    const std::span<std::uint32_t> groups = order.subspan(order.size() / 2);
    const std::span<std::uint32_t> parent =
        std::span(scratch.parent).subspan(pair.points.first, pair.points.count);
    pair.clusters = group_points(scratch.cluster_points,
                                 context.model.bodies.at<BodyModels>(pair.body).region_threshold,
                                 {parent, pair.clusters}, order.first(order.size() / 2), groups);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].cluster = groups[i];
    }
  }
}

}  // namespace torsion::engine
