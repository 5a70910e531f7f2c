#include "systems/unite_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace torsion {
namespace {

// Of the mesh's size. Places nearer than kSamePlace are one; a triangle's two sides are looked at
// so far from it.
constexpr double kSamePlace = 1e-9;
constexpr double kBeside = 1e-7;
constexpr double kParallel = 1e-9;  // sine of the angle between planes that are the same

struct Facet {
  std::array<glm::dvec3, 3> corner;
  glm::dvec3 normal{0.0};  // unit; zero without area
  Bounds box;
  std::uint32_t shell = 0;
};

struct Segment {
  glm::dvec3 from{0.0};
  glm::dvec3 to{0.0};
};

/// A convex, flat piece of a triangle.
using Polygon = std::vector<glm::dvec3>;

/// A plane through a point.
struct Plane {
  glm::dvec3 point{0.0};
  glm::dvec3 normal{0.0};  // unit
  [[nodiscard]] double height(const glm::dvec3& at) const { return glm::dot(normal, at - point); }
};

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t row) {
  while (parent[row] != row) {
    parent[row] = parent[parent[row]];
    row = parent[row];
  }
  return row;
}

/// Triangles that share vertices.
/// @return how many shells there are
std::uint32_t number_shells(const SurfaceMesh& mesh, std::vector<Facet>& facets) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const glm::uvec3& t : mesh.triangles) {
    parent[root_of(parent, t.y)] = root_of(parent, t.x);
    parent[root_of(parent, t.z)] = root_of(parent, t.x);
  }
  std::map<std::uint32_t, std::uint32_t> shells;
  for (std::size_t row = 0; row < facets.size(); ++row) {
    const std::uint32_t root = root_of(parent, mesh.triangles[row].x);
    facets[row].shell =
        shells.emplace(root, static_cast<std::uint32_t>(shells.size())).first->second;
  }
  return static_cast<std::uint32_t>(shells.size());
}

std::vector<Facet> facets_of(const SurfaceMesh& mesh) {
  std::vector<Facet> facets;
  for (const glm::uvec3& t : mesh.triangles) {
    Facet facet{{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]}, {}, {}, 0};
    const auto& [a, b, c] = facet.corner;
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    facet.normal = length > 0.0 ? cross / length : glm::dvec3(0.0);
    facet.box = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
    facets.push_back(facet);
  }
  return facets;
}

bool boxes_meet(const Bounds& a, const Bounds& b, double slack) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lowest[axis] > b.highest[axis] + slack || b.lowest[axis] > a.highest[axis] + slack) {
      return false;
    }
  }
  return true;
}

/// The part of the line on both planes that lies in a facet: places along `direction` from
/// `origin`.
std::optional<std::pair<double, double>> crossing(const Facet& facet,
                                                  const std::array<double, 3>& heights,
                                                  const glm::dvec3& origin,
                                                  const glm::dvec3& direction, double same) {
  std::optional<std::pair<double, double>> found;
  const auto take = [&](const glm::dvec3& at) {
    const double place = glm::dot(direction, at - origin);
    found = found ? std::pair(std::min(found->first, place), std::max(found->second, place))
                  : std::pair(place, place);
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

std::array<double, 3> heights_over(const Facet& facet, const Plane& plane) {
  return {plane.height(facet.corner[0]), plane.height(facet.corner[1]),
          plane.height(facet.corner[2])};
}

bool is_coplanar(const Facet& a, const Facet& b, double same) {
  const std::array<double, 3> heights = heights_over(a, {b.corner[0], b.normal});
  return std::ranges::all_of(heights, [same](double h) { return std::abs(h) <= same; });
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
  const glm::dvec3 origin = a.corner[0];
  const auto in_a = crossing(a, over_b, origin, direction, same);
  const auto in_b = crossing(b, over_a, origin, direction, same);
  if (!in_a || !in_b) {
    return std::nullopt;
  }
  const double from = std::max(in_a->first, in_b->first);
  const double to = std::min(in_a->second, in_b->second);
  if (to - from <= same) {
    return std::nullopt;
  }
  // A point of the line: a's crossing with b's plane.
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    std::optional<glm::dvec3> point;
    if (std::abs(over_b[k]) <= same) {
      point = a.corner[k];
    } else if (std::abs(over_b[next]) > same && (over_b[k] > 0.0) != (over_b[next] > 0.0)) {
      const double share = over_b[k] / (over_b[k] - over_b[next]);
      point = a.corner[k] + share * (a.corner[next] - a.corner[k]);
    }
    if (point) {
      const double place = glm::dot(direction, *point - origin);
      return Segment{*point + (from - place) * direction, *point + (to - place) * direction};
    }
  }
  return std::nullopt;
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

/// Cuts the pieces through which the segment goes along the plane.
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

/// Cuts a facet's pieces along another one.
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

double solid_angle(const Facet& facet, const glm::dvec3& from) {
  const glm::dvec3 a = facet.corner[0] - from;
  const glm::dvec3 b = facet.corner[1] - from;
  const glm::dvec3 c = facet.corner[2] - from;
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  return 2.0 *
         std::atan2(glm::dot(a, glm::cross(b, c)),
                    la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

double winding_number(const std::vector<Facet>& facets, const glm::dvec3& point) {
  double sum = 0.0;
  for (const Facet& facet : facets) {
    sum += solid_angle(facet, point);
  }
  return sum / (4.0 * std::numbers::pi);
}

glm::dvec3 middle_of(const Polygon& polygon) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& corner : polygon) {
    sum += corner;
  }
  return sum / static_cast<double>(polygon.size());
}

bool is_in(const Facet& facet, const glm::dvec3& point, double same) {
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 edge = facet.corner[(k + 1) % 3] - facet.corner[k];
    if (glm::dot(glm::cross(facet.normal, edge), point - facet.corner[k]) <
        -same * glm::length(edge)) {
      return false;
    }
  }
  return true;
}

/// Everything of one mesh.
class Uniter {
 public:
  explicit Uniter(const SurfaceMesh& mesh)
      : mesh_(mesh), facets_(facets_of(mesh)), shells_(number_shells(mesh, facets_)) {
    Bounds box = facets_[0].box;
    for (const Facet& facet : facets_) {
      box.lowest = glm::min(box.lowest, facet.box.lowest);
      box.highest = glm::max(box.highest, facet.box.highest);
    }
    const double size = glm::distance(box.lowest, box.highest);
    same_ = kSamePlace * size;
    beside_ = kBeside * size;
  }

  [[nodiscard]] std::uint32_t shells() const { return shells_; }

  /// For each facet those of other shells whose boxes it meets.
  void find_neighbours() {
    meets_.assign(facets_.size(), {});
    std::vector<std::uint32_t> order(facets_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [this](std::uint32_t a, std::uint32_t b) {
      const double at = facets_[a].box.lowest.x;
      const double bt = facets_[b].box.lowest.x;
      return at < bt || (at == bt && a < b);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Facet& one = facets_[order[i]];
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const Facet& other = facets_[order[j]];
        if (other.box.lowest.x > one.box.highest.x + same_) {
          break;
        }
        if (one.shell != other.shell && boxes_meet(one.box, other.box, same_) &&
            (is_coplanar(one, other, same_) || crossing_of(one, other, same_))) {
          meets_[order[i]].push_back(order[j]);
          meets_[order[j]].push_back(order[i]);
        }
      }
    }
  }

  /// Facets that nothing cuts go together with their neighbours across edges: a patch of them is
  /// outside or inside as a whole.
  void find_whole_patches() {
    patch_.resize(facets_.size());
    std::iota(patch_.begin(), patch_.end(), 0U);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first;
    for (std::uint32_t row = 0; row < facets_.size(); ++row) {
      const glm::uvec3& t = mesh_.triangles[row];
      for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)}) {
        const auto [at, is_new] = first.emplace(std::minmax(a, b), row);
        if (!is_new && meets_[row].empty() && meets_[at->second].empty()) {
          patch_[root_of(patch_, row)] = root_of(patch_, at->second);
        }
      }
    }
  }

  /// Whether a piece of a facet bounds the solid.
  [[nodiscard]] bool is_outside(std::uint32_t row, const glm::dvec3& point) const {
    const Facet& facet = facets_[row];
    // Of faces that lie in each other one is enough.
    for (const std::uint32_t other : meets_[row]) {
      if (other < row && glm::dot(facets_[other].normal, facet.normal) > 0.0 &&
          is_coplanar(facet, facets_[other], same_) && is_in(facets_[other], point, 0.0)) {
        return false;
      }
    }
    return winding_number(facets_, point + beside_ * facet.normal) < 0.5 &&
           winding_number(facets_, point - beside_ * facet.normal) > 0.5;
  }

  void keep_outside(Union& united) {
    std::map<std::uint32_t, bool> patches;
    for (std::uint32_t row = 0; row < facets_.size(); ++row) {
      const Facet& facet = facets_[row];
      const Polygon whole(facet.corner.begin(), facet.corner.end());
      if (meets_[row].empty()) {
        const std::uint32_t root = root_of(patch_, row);
        auto known = patches.find(root);
        if (known == patches.end()) {
          known = patches.emplace(root, is_outside(row, middle_of(whole))).first;
        }
        if (known->second) {
          kept_.push_back(whole);
        } else {
          united.buried += 1;
        }
        continue;
      }
      std::vector<Polygon> pieces{whole};
      for (const std::uint32_t other : meets_[row]) {
        cut_by(pieces, facet, facets_[other], same_);
      }
      united.cut += pieces.size() > 1 ? 1U : 0U;
      for (Polygon& piece : pieces) {
        if (is_outside(row, middle_of(piece))) {
          kept_.push_back(std::move(piece));
        }
      }
    }
  }

  /// The kept pieces as one mesh, without places where an edge ends in the middle of another.
  /// @return whether it is closed
  bool close(SurfaceMesh& surface) {
    std::vector<std::vector<std::uint32_t>> polygons;
    for (const Polygon& piece : kept_) {
      std::vector<std::uint32_t> rows;
      for (const glm::dvec3& corner : piece) {
        const std::uint32_t row = vertex_at(corner, surface);
        if (rows.empty() || (rows.back() != row && rows.front() != row)) {
          rows.push_back(row);
        }
      }
      if (rows.size() >= 3) {
        polygons.push_back(std::move(rows));
      }
    }
    std::vector<std::uint32_t> by_x(surface.positions.size());
    std::iota(by_x.begin(), by_x.end(), 0U);
    std::ranges::sort(by_x, [&surface](std::uint32_t a, std::uint32_t b) {
      return surface.positions[a].x < surface.positions[b].x;
    });
    for (const std::vector<std::uint32_t>& polygon : polygons) {
      append_triangles(with_vertices_on_edges(polygon, by_x, surface), surface);
    }
    return is_closed(surface);
  }

 private:
  /// The row of a vertex there, which is new if there was none.
  std::uint32_t vertex_at(const glm::dvec3& point, SurfaceMesh& surface) {
    const double cell = 16.0 * same_;
    const glm::dvec3 scaled = glm::floor(point / cell);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = places_.find({scaled.x + dx, scaled.y + dy, scaled.z + dz});
          if (found == places_.end()) {
            continue;
          }
          for (const std::uint32_t row : found->second) {
            if (glm::distance(surface.positions[row], point) <= 8.0 * same_) {
              return row;
            }
          }
        }
      }
    }
    const auto row = static_cast<std::uint32_t>(surface.positions.size());
    surface.positions.push_back(point);
    places_[{scaled.x, scaled.y, scaled.z}].push_back(row);
    return row;
  }

  [[nodiscard]] std::vector<std::uint32_t> with_vertices_on_edges(
      const std::vector<std::uint32_t>& polygon, const std::vector<std::uint32_t>& by_x,
      const SurfaceMesh& surface) const {
    std::vector<std::uint32_t> all;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t from = polygon[k];
      const std::uint32_t to = polygon[(k + 1) % polygon.size()];
      const glm::dvec3& a = surface.positions[from];
      const glm::dvec3 way = surface.positions[to] - a;
      const double length = glm::length(way);
      const double slack = 8.0 * same_;
      const double lowest = std::min(a.x, a.x + way.x) - slack;
      const double highest = std::max(a.x, a.x + way.x) + slack;
      std::vector<std::pair<double, std::uint32_t>> between;
      auto at = std::partition_point(by_x.begin(), by_x.end(), [&](std::uint32_t row) {
        return surface.positions[row].x < lowest;
      });
      for (; at != by_x.end() && surface.positions[*at].x <= highest; ++at) {
        if (*at == from || *at == to) {
          continue;
        }
        const glm::dvec3 offset = surface.positions[*at] - a;
        const double along = glm::dot(offset, way) / length;
        if (along > 0.0 && along < length && glm::length(offset - along / length * way) <= slack) {
          between.emplace_back(along, *at);
        }
      }
      std::ranges::sort(between);
      all.push_back(from);
      for (const auto& [along, row] : between) {
        all.push_back(row);
      }
    }
    return all;
  }

  static void append_triangles(const std::vector<std::uint32_t>& polygon, SurfaceMesh& surface) {
    if (polygon.size() == 3) {
      surface.triangles.emplace_back(polygon[0], polygon[1], polygon[2]);
      return;
    }
    // From the middle, so that corners in a row make no triangle without area.
    glm::dvec3 sum(0.0);
    for (const std::uint32_t row : polygon) {
      sum += surface.positions[row];
    }
    const auto middle = static_cast<std::uint32_t>(surface.positions.size());
    surface.positions.push_back(sum / static_cast<double>(polygon.size()));
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      surface.triangles.emplace_back(polygon[k], polygon[(k + 1) % polygon.size()], middle);
    }
  }

  static bool is_closed(const SurfaceMesh& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const glm::uvec3& t : surface.triangles) {
      for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)}) {
        edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
    }
    return !surface.triangles.empty() &&
           std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
  }

  const SurfaceMesh& mesh_;
  std::vector<Facet> facets_;
  std::uint32_t shells_;
  double same_ = 0.0;    // m
  double beside_ = 0.0;  // m
  std::vector<std::vector<std::uint32_t>> meets_;
  std::vector<std::uint32_t> patch_;
  std::vector<Polygon> kept_;
  std::map<std::array<double, 3>, std::vector<std::uint32_t>> places_;
};

SurfaceMesh joined(const std::vector<const SurfaceMesh*>& meshes) {
  SurfaceMesh all;
  for (const SurfaceMesh* mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), mesh->positions.begin(), mesh->positions.end());
    for (const glm::uvec3& triangle : mesh->triangles) {
      all.triangles.push_back(triangle + first);
    }
  }
  return all;
}

Bounds box_of(const SurfaceMesh& mesh) {
  Bounds box{mesh.positions[0], mesh.positions[0]};
  for (const glm::dvec3& position : mesh.positions) {
    box.lowest = glm::min(box.lowest, position);
    box.highest = glm::max(box.highest, position);
  }
  return box;
}

/// Mesh parts in groups whose boxes meet.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<PartDescription>& parts) {
  std::vector<std::uint32_t> parent(parts.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto is_mesh = [&parts](std::size_t row) {
    return parts[row].shape.kind == ShapeKind::kMesh && !parts[row].surface.positions.empty();
  };
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      if (is_mesh(i) && is_mesh(j) &&
          boxes_meet(box_of(parts[i].surface), box_of(parts[j].surface), 0.0)) {
        parent[root_of(parent, i)] = root_of(parent, j);
      }
    }
  }
  std::map<std::uint32_t, std::vector<std::size_t>> groups;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    if (is_mesh(i)) {
      groups[root_of(parent, i)].push_back(i);
    }
  }
  std::vector<std::vector<std::size_t>> listed;
  listed.reserve(groups.size());
  for (auto& [root, rows] : groups) {
    listed.push_back(std::move(rows));
  }
  return listed;
}

}  // namespace

Result<Union> unite_shells(const SurfaceMesh& mesh) {
  Union united;
  if (mesh.triangles.empty()) {
    return united;
  }
  Uniter uniter(mesh);
  if (uniter.shells() < 2) {
    return united;
  }
  uniter.find_neighbours();
  uniter.find_whole_patches();
  uniter.keep_outside(united);
  united.changed = united.buried + united.cut > 0;
  if (united.changed && !uniter.close(united.surface)) {
    return Error{
        "its meshes overlap or touch, and their union could not be found: join them in a modeller "
        "(Blender: boolean modifier, union), or let them overlap by more"};
  }
  return united;
}

Result<std::vector<std::string>> unite_parts(std::vector<PartDescription>& parts,
                                             bool with_others) {
  std::vector<std::string> nodes;
  const auto error_of = [&parts](std::size_t row, const Error& error) {
    return Error{"node '" + parts[row].node + "': " + error.text};
  };
  for (std::size_t row = 0; row < parts.size(); ++row) {
    if (parts[row].shape.kind != ShapeKind::kMesh) {
      continue;
    }
    Result<Union> united = unite_shells(parts[row].surface);
    if (!united) {
      return error_of(row, united.error());
    }
    if (united.value().changed) {
      nodes.push_back(parts[row].node);
      parts[row].surface = std::move(united).value().surface;
    }
  }
  for (const std::vector<std::size_t>& group : groups_of(parts)) {
    if (!with_others || group.size() < 2) {
      continue;
    }
    std::vector<const SurfaceMesh*> meshes;
    meshes.reserve(group.size());
    for (const std::size_t row : group) {
      meshes.push_back(&parts[row].surface);
    }
    Result<Union> united = unite_shells(joined(meshes));
    if (!united) {
      return error_of(group[0], united.error());
    }
    if (!united.value().changed) {
      continue;
    }
    const auto solid = std::make_shared<const SurfaceMesh>(std::move(united).value().surface);
    for (const std::size_t row : group) {
      nodes.push_back(parts[row].node);
      parts[row].solid = solid;
    }
  }
  return nodes;
}

}  // namespace torsion
