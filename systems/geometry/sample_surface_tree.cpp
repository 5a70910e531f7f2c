#include "systems/geometry/sample_surface_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

namespace torsion {
namespace {

constexpr std::size_t kBucket = 8;  // leaves under one ball: a walk looks at all of them at once

/// Splits the rows at the median of the longest side of their points' box. @return how many are in
/// the lower half
std::size_t split(std::span<const glm::dvec3> points, std::span<std::uint32_t> rows) {
  glm::dvec3 lowest = points[rows[0]];
  glm::dvec3 highest = lowest;
  for (const std::uint32_t row : rows) {
    lowest = glm::min(lowest, points[row]);
    highest = glm::max(highest, points[row]);
  }
  const glm::dvec3 extent = highest - lowest;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = rows.size() / 2;
  std::nth_element(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(half), rows.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis]
                                                               : a < b;
                   });
  return half;
}

void add_leaf(std::span<const glm::dvec3> points, std::uint32_t row, PointTree& tree) {
  SurfaceBall ball;
  ball.center = points[row];
  ball.sample = static_cast<std::uint32_t>(tree.order.size());
  ball.skip = static_cast<std::uint32_t>(tree.balls.size() + 1);
  tree.order.push_back(row);
  tree.balls.push_back(ball);
}

void add_subtree(std::span<const glm::dvec3> points, std::span<std::uint32_t> rows,
                 PointTree& tree) {
  const std::size_t own = tree.balls.size();
  tree.balls.push_back(SurfaceBall{});
  if (rows.size() <= kBucket) {
    for (const std::uint32_t row : rows) {
      add_leaf(points, row, tree);
    }
  } else {
    const std::size_t half = split(points, rows);
    for (const std::span<std::uint32_t> part : {rows.first(half), rows.subspan(half)}) {
      const std::size_t quarter = split(points, part);
      add_subtree(points, part.first(quarter), tree);
      add_subtree(points, part.subspan(quarter), tree);
    }
  }
  tree.balls[own].skip = static_cast<std::uint32_t>(tree.balls.size());
}

/// The smallest ball about the leaf balls in `below`, nearly: Badoiu and Clarkson, "Smaller
/// core-sets for balls", 2003: walk towards the farthest ball by 1 / (k + 1) of the way.
void fit_ball(std::span<const SurfaceBall> below, SurfaceBall& ball) {
  const auto farthest = [&](const glm::dvec3& center) {
    const SurfaceBall* found = nullptr;
    double reach = -1.0;
    for (const SurfaceBall& leaf : below) {
      if (leaf.sample == kNoRow) {
        continue;
      }
      const double leaf_reach = glm::distance(center, leaf.center) + leaf.radius;
      if (leaf_reach > reach) {
        reach = leaf_reach;
        found = &leaf;
      }
    }
    return std::pair(found, reach);
  };
  constexpr int kWalk = 32;
  glm::dvec3 center = farthest(below.back().center).first->center;
  ball.radius = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= kWalk; ++k) {
    const auto [leaf, reach] = farthest(center);
    if (reach < ball.radius) {
      ball.radius = reach;
      ball.center = center;
    }
    const glm::dvec3 way = leaf->center - center;
    const double length = std::sqrt(glm::dot(way, way));
    if (!(length > 0.0)) {
      break;
    }
    // to the far end of the leaf's ball, not only to its centre
    center += way * ((1.0 + leaf->radius / length) / (k + 1.0));
  }
  ball.radius *= 1.0 + 1e-12;
}

}  // namespace

PointTree point_tree(std::span<const glm::dvec3> points) {
  PointTree tree;
  if (points.empty()) {
    return tree;
  }
  std::vector<std::uint32_t> rows(points.size());
  std::iota(rows.begin(), rows.end(), 0U);
  add_subtree(points, rows, tree);
  fit_balls(tree.balls);
  return tree;
}

void fit_balls(std::span<SurfaceBall> balls) {
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (balls[row].sample == kNoRow) {
      fit_ball(balls.subspan(row + 1, balls[row].skip - row - 1), balls[row]);
    }
  }
}

std::uint32_t nearest_leaf(std::span<const SurfaceBall> balls,
                           std::span<const glm::dvec3> leaf_centers, const glm::dvec3& point,
                           std::uint32_t hint) {
  std::uint32_t nearest = hint;
  double best = glm::distance(point, leaf_centers[hint]);
  for (std::uint32_t row = 0; row < balls.size();) {
    const SurfaceBall& ball = balls[row];
    const glm::dvec3 difference = point - ball.center;
    const double squared = glm::dot(difference, difference);
    const double reach = best + ball.radius;
    if (squared > reach * reach) {
      row = ball.skip;
      continue;
    }
    if (ball.sample != kNoRow && squared < best * best) {
      best = std::sqrt(squared);
      nearest = ball.sample;
    }
    ++row;
  }
  return nearest;
}

}  // namespace torsion
