#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "systems/geometry/distance_shapes.hpp"
#include "systems/geometry/sample_surface.hpp"

namespace torsion::engine {
namespace {

/// Moves a point of the box of half extents `half` to the surface of the shape inside the box: flat
/// faces stay flat, and the box's edges become the shape's.
glm::dvec3 from_box_to_shape(const ShapePart& shape, const glm::dvec3& p) {
  const glm::dvec3& half = shape.half_extent;
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return half.x * glm::normalize(p);
    case ShapeKind::kEllipsoid:
      return half * glm::normalize(p / half);
    case ShapeKind::kCylinder: {
      const double square = larger(std::abs(p.x), std::abs(p.z));
      const double round = std::sqrt(p.x * p.x + p.z * p.z);
      const double scale = round > 0.0 ? square / round : 1.0;
      return {p.x * scale, p.y, p.z * scale};
    }
    case ShapeKind::kCapsule: {
      const double segment = larger(half.y - half.x, 0.0);
      const glm::dvec3 axis_point(0.0, std::clamp(p.y, -segment, segment), 0.0);
      return axis_point + half.x * glm::normalize(p - axis_point);
    }
    default:
      return p;
  }
}

/// The box that from_box_to_shape starts from.
glm::dvec3 enclosing_box(const ShapePart& shape) {
  const glm::dvec3& half = shape.half_extent;
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return glm::dvec3(half.x);
    case ShapeKind::kCylinder:
      return {half.x, half.y, half.x};
    case ShapeKind::kCapsule:
      return {half.x, larger(half.y, half.x), half.x};
    default:
      return half;
  }
}

/// Adds a piece unless it has no area or is hidden in another part.
void add_piece(const std::array<glm::dvec3, 3>& corner, std::uint32_t part, double bulge,
               const PartSolids& solids, std::vector<SurfaceTriangle>& pieces) {
  const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double length = std::sqrt(glm::dot(normal, normal));
  if (!(length > 0.0)) {
    return;
  }
  const glm::dvec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
  const double reach = std::max({glm::distance(middle, corner[0]), glm::distance(middle, corner[1]),
                                 glm::distance(middle, corner[2])});
  if (!solids.inside_others(middle, part, reach + bulge)) {
    pieces.push_back({corner, 0.5 * length, normal / length, bulge, part});
  }
}

/// How far the exact surface lies from a piece, measured at its middle and the middles of its
/// edges; half more for the places between.
double bulge_of(const ShapePart& shape, const std::array<glm::dvec3, 3>& corner) {
  double bulge = 0.0;
  for (const glm::dvec3& point :
       {(corner[0] + corner[1] + corner[2]) / 3.0, 0.5 * (corner[0] + corner[1]),
        0.5 * (corner[1] + corner[2]), 0.5 * (corner[2] + corner[0])}) {
    bulge = larger(bulge, std::abs(exact_distance(shape, point).value));
  }
  return 1.5 * bulge;
}

/// One face of the box, cut into squares: the one where `axis` is `side` times its half extent.
void add_face(const ShapePart& shape, std::uint32_t part, int axis, double side, double step,
              const PartSolids& solids, std::vector<SurfaceTriangle>& pieces) {
  const glm::dvec3 box = enclosing_box(shape);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const auto cuts = [&](int along) {
    return static_cast<int>(std::clamp(std::ceil(2.0 * box[along] / step), 4.0, 1024.0));
  };
  const int cuts_u = cuts(u);
  const int cuts_v = cuts(v);
  const auto corner = [&](int i, int j) {
    glm::dvec3 p(0.0);
    p[axis] = side * box[axis];
    p[u] = box[u] * (2.0 * i / cuts_u - 1.0);
    p[v] = box[v] * (2.0 * j / cuts_v - 1.0);
    return shape.pose.position + shape.pose.rotation * from_box_to_shape(shape, p);
  };
  for (int j = 0; j < cuts_v; ++j) {
    for (int i = 0; i < cuts_u; ++i) {
      const glm::dvec3 a = corner(i, j);
      const glm::dvec3 b = corner(i + 1, j);
      const glm::dvec3 c = corner(i + 1, j + 1);
      const glm::dvec3 d = corner(i, j + 1);
      for (std::array<glm::dvec3, 3> triangle : {std::array{a, b, c}, std::array{a, c, d}}) {
        if (side < 0.0) {
          std::swap(triangle[1], triangle[2]);
        }
        add_piece(triangle, part, bulge_of(shape, triangle), solids, pieces);
      }
    }
  }
}

void add_exact_shape(const ShapePart& shape, std::uint32_t part, double squares,
                     const PartSolids& solids, std::vector<SurfaceTriangle>& pieces) {
  const glm::dvec3 box = enclosing_box(shape);
  const double area = 8.0 * (box.x * box.y + box.y * box.z + box.z * box.x);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      add_face(shape, part, axis, side, std::sqrt(area / squares), solids, pieces);
    }
  }
}

}  // namespace

Distance exact_distance(const ShapePart& shape, const glm::dvec3& point) {
  const glm::dvec3 local = glm::conjugate(shape.pose.rotation) * (point - shape.pose.position);
  Distance distance =
      with_exact_shape(shape, [&](const auto& exact) { return exact(local.x, local.y, local.z); });
  distance.gradient = shape.pose.rotation * distance.gradient;
  return distance;
}

PartSolids::PartSolids(std::span<const PartDescription> parts)
    : parts_(parts), meshes_(parts.size()), boxes_(parts.size()) {
  for (std::size_t part = 0; part < parts.size() && parts.size() > 1; ++part) {
    if (parts[part].shape.kind != ShapeKind::kMesh) {
      continue;
    }
    if (Result<MeshDistance> mesh = MeshDistance::build(parts[part].surface)) {
      const std::vector<glm::dvec3>& positions = parts[part].surface.positions;
      meshes_[part] = std::move(mesh).value();
      boxes_[part] = {positions[0], positions[0]};
      for (const glm::dvec3& position : positions) {
        boxes_[part].lowest = glm::min(boxes_[part].lowest, position);
        boxes_[part].highest = glm::max(boxes_[part].highest, position);
      }
    }
  }
}

double PartSolids::distance_inside(std::uint32_t part, const glm::dvec3& point) const {
  const ShapePart& shape = parts_[part].shape;
  if (shape.kind != ShapeKind::kMesh) {
    return exact_distance(shape, point).value;
  }
  const bool in_box = glm::all(glm::greaterThan(point, boxes_[part].lowest)) &&
                      glm::all(glm::lessThan(point, boxes_[part].highest));
  return in_box && meshes_[part] ? meshes_[part]->closest(point).distance.value : 0.0;
}

bool PartSolids::inside_others(const glm::dvec3& point, std::uint32_t own, double margin) const {
  for (std::uint32_t part = 0; part < parts_.size(); ++part) {
    if (part != own && distance_inside(part, point) < -margin) {
      return true;
    }
  }
  return false;
}

std::vector<SurfaceTriangle> surface_pieces(std::span<const PartDescription> parts,
                                            const PartSolids& solids, std::uint32_t target_count) {
  // About 4 squares for each sample, and enough on each part for its shape.
  const double squares =
      4.0 * target_count / static_cast<double>(std::max<std::size_t>(parts.size(), 1)) + 600.0;
  std::vector<SurfaceTriangle> pieces;
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    if (parts[part].shape.kind != ShapeKind::kMesh) {
      add_exact_shape(parts[part].shape, part, squares, solids, pieces);
      continue;
    }
    const SurfaceMesh& mesh = parts[part].surface;
    for (const glm::uvec3& triangle : mesh.triangles) {
      add_piece(
          {mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]},
          part, 0.0, solids, pieces);
    }
  }
  return pieces;
}

namespace {

constexpr std::size_t kBucket = 8;  // leaves under one ball: a walk looks at all of them at once

/// Splits the rows at the median of the longest side of their points' box.
/// @return the number of rows in the lower half
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

/// Nearly the smallest ball around the leaf balls in `below`. Badoiu and Clarkson, "Smaller
/// core-sets for balls", 2003: move by 1 / (k + 1) of the distance towards the farthest ball, again
/// and again.
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
    // to the far side of the leaf's ball, not only to its centre
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

}  // namespace torsion::engine
