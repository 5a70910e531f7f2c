#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/geometry/bounds.hpp"
#include "systems/geometry/unite_meshes.hpp"

namespace torsion::engine {
namespace {

constexpr double kParallel = 1e-9;  // sine of the angle between planes that are the same

struct Segment {
  glm::dvec3 from{0.0};
  glm::dvec3 to{0.0};
};

/// A plane through a point.
struct Plane {
  glm::dvec3 point{0.0};
  glm::dvec3 normal{0.0};  // unit
  [[nodiscard]] double height(const glm::dvec3& at) const { return glm::dot(normal, at - point); }
};

/// The part of a line that lies in a facet: places along its direction, m, and the point at the
/// first.
struct Crossing {
  double from = 0.0;
  double to = 0.0;
  glm::dvec3 first{0.0};
};

std::array<double, 3> heights_over(const Facet& facet, const Plane& plane) {
  return {plane.height(facet.corner[0]), plane.height(facet.corner[1]),
          plane.height(facet.corner[2])};
}

/// @param heights  of the facet's corners over the other plane
/// @param origin, direction  of the line: where places count from, and a unit vector along both
/// planes
std::optional<Crossing> crossing_with(const Facet& facet, const std::array<double, 3>& heights,
                                      const glm::dvec3& origin, const glm::dvec3& direction,
                                      double same) {
  std::optional<Crossing> found;
  const auto take = [&](const glm::dvec3& at) {
    const double place = glm::dot(direction, at - origin);
    if (!found) {
      found = Crossing{place, place, at};
    } else if (place < found->from) {
      found->from = place;
      found->first = at;
    } else {
      found->to = std::max(found->to, place);
    }
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (std::abs(heights[k]) <= same) {
      take(facet.corner[k]);
    } else if (std::abs(heights[next]) > same && (heights[k] > 0.0) != (heights[next] > 0.0)) {
      const double share = heights[k] / (heights[k] - heights[next]);
      take(facet.corner[k] + share * (facet.corner[next] - facet.corner[k]));
    }
  }
  return found;
}

/// Where two facets that are not coplanar cross or touch along a line: Moeller, J. Graphics Tools 2
/// (1997) 25.
std::optional<Segment> crossing_of(const Facet& a, const Facet& b, double same) {
  const std::array<double, 3> over_b = heights_over(a, {b.corner[0], b.normal});
  const std::array<double, 3> over_a = heights_over(b, {a.corner[0], a.normal});
  const auto one_side = [same](const std::array<double, 3>& heights) {
    return std::ranges::all_of(heights, [same](double h) { return h > same; }) ||
           std::ranges::all_of(heights, [same](double h) { return h < -same; });
  };
  const glm::dvec3 cross = glm::cross(a.normal, b.normal);
  const double sine = glm::length(cross);
  if (one_side(over_b) || one_side(over_a) || sine < kParallel) {
    return std::nullopt;
  }
  const glm::dvec3 direction = cross / sine;
  const auto in_a = crossing_with(a, over_b, a.corner[0], direction, same);
  const auto in_b = crossing_with(b, over_a, a.corner[0], direction, same);
  if (!in_a || !in_b) {
    return std::nullopt;
  }
  const double from = std::max(in_a->from, in_b->from);
  const double to = std::min(in_a->to, in_b->to);
  if (to - from <= same) {
    return std::nullopt;
  }
  const auto at = [&](double place) {
    return in_a->first + (place - in_a->from) * direction;
  };
  return Segment{at(from), at(to)};
}

/// The length of a segment that lies in a convex polygon.
double length_inside(const Polygon& polygon, const glm::dvec3& normal, const Segment& segment) {
  double from = 0.0;
  double to = 1.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec3& a = polygon[k];
    const glm::dvec3& b = polygon[(k + 1) % polygon.size()];
    const glm::dvec3 edge = b - a;
    const double length = glm::length(edge);
    if (length == 0.0) {
      continue;
    }
    const glm::dvec3 inward = glm::cross(normal, edge / length);
    const double start = glm::dot(inward, segment.from - a);
    const double end = glm::dot(inward, segment.to - a);
    if (start <= 0.0 && end <= 0.0) {
      return 0.0;
    }
    if ((start > 0.0) != (end > 0.0)) {
      const double at = start / (start - end);
      (start > 0.0 ? to : from) = start > 0.0 ? std::min(to, at) : std::max(from, at);
    }
  }
  return std::max(to - from, 0.0) * glm::distance(segment.from, segment.to);
}

/// Cuts the pieces that the segment crosses along the plane.
void cut_along(std::vector<Polygon>& pieces, const glm::dvec3& normal, const Plane& plane,
               const Segment& segment, double same) {
  std::vector<Polygon> cut;
  for (Polygon& piece : pieces) {
    if (length_inside(piece, normal, segment) <= same) {
      cut.push_back(std::move(piece));
      continue;
    }
    Polygon above;
    Polygon below;
    bool any_above = false;
    bool any_below = false;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const glm::dvec3& at = piece[k];
      const glm::dvec3& next = piece[(k + 1) % piece.size()];
      const double here = plane.height(at);
      const double there = plane.height(next);
      if (here >= -same) {
        above.push_back(at);
        any_above = any_above || here > same;
      }
      if (here <= same) {
        below.push_back(at);
        any_below = any_below || here < -same;
      }
      if ((here > same && there < -same) || (here < -same && there > same)) {
        const glm::dvec3 point = at + here / (here - there) * (next - at);
        above.push_back(point);
        below.push_back(point);
      }
    }
    if (any_above && any_below) {
      cut.push_back(std::move(above));
      cut.push_back(std::move(below));
    } else {
      cut.push_back(std::move(piece));
    }
  }
  pieces = std::move(cut);
}

}  // namespace

std::vector<Facet> facets_of(const SurfaceMesh& mesh) {
  std::vector<Facet> facets;
  for (const glm::uvec3& t : mesh.triangles) {
    Facet facet{{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]}, {}, {}};
    const auto& [a, b, c] = facet.corner;
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    facet.normal = length > 0.0 ? cross / length : glm::dvec3(0.0);
    facet.box = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
    facets.push_back(facet);
  }
  return facets;
}

bool is_coplanar(const Facet& a, const Facet& b, double same) {
  const std::array<double, 3> heights = heights_over(a, {b.corner[0], b.normal});
  return std::ranges::all_of(heights, [same](double h) { return std::abs(h) <= same; });
}

bool do_cross(const Facet& a, const Facet& b, double same) {
  return is_coplanar(a, b, same) || crossing_of(a, b, same).has_value();
}

bool is_in(const Facet& facet, const glm::dvec3& place) {
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 edge = facet.corner[(k + 1) % 3] - facet.corner[k];
    if (glm::dot(glm::cross(facet.normal, edge), place - facet.corner[k]) < 0.0) {
      return false;
    }
  }
  return true;
}

void cut_by(std::vector<Polygon>& pieces, const Facet& facet, const Facet& other, double same) {
  if (is_coplanar(facet, other, same)) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Segment edge{other.corner[k], other.corner[(k + 1) % 3]};
      const glm::dvec3 way = edge.to - edge.from;
      const double length = glm::length(way);
      if (length > 0.0) {
        cut_along(pieces, facet.normal,
                  {edge.from, glm::normalize(glm::cross(other.normal, way / length))}, edge, same);
      }
    }
    return;
  }
  if (const std::optional<Segment> segment = crossing_of(facet, other, same)) {
    cut_along(pieces, facet.normal, {other.corner[0], other.normal}, *segment, same);
  }
}

}  // namespace torsion::engine
