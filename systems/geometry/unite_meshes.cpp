#include "systems/geometry/unite_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/geometry/bounds.hpp"
#include "systems/math/disjoint_sets.hpp"

namespace torsion::engine {
namespace {

constexpr double kCornersApart = 8.0;  // of what is the same: a corner is found from two sides

/// Vertices by the grid cell that they lie in.
using Places = std::map<std::array<double, 3>, std::vector<std::uint32_t>>;

/// The row of the vertex at this place; a new one if there is none.
std::uint32_t vertex_at(const glm::dvec3& point, double slack, Places& places,
                        SurfaceMesh& surface) {
  const double cell = 2.0 * slack;
  const glm::dvec3 scaled = glm::floor(point / cell);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const auto found = places.find({scaled.x + dx, scaled.y + dy, scaled.z + dz});
        if (found == places.end()) {
          continue;
        }
        for (const std::uint32_t row : found->second) {
          if (glm::distance(surface.positions[row], point) <= slack) {
            return row;
          }
        }
      }
    }
  }
  const auto row = static_cast<std::uint32_t>(surface.positions.size());
  surface.positions.push_back(point);
  places[{scaled.x, scaled.y, scaled.z}].push_back(row);
  return row;
}

/// A polygon's corners and all vertices that lie on its edges, in order.
/// @param by_x  rows of all vertices by their x
std::vector<std::uint32_t> with_vertices_on_edges(const std::vector<std::uint32_t>& polygon,
                                                  const std::vector<std::uint32_t>& by_x,
                                                  const SurfaceMesh& surface, double slack) {
  std::vector<std::uint32_t> all;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const std::uint32_t from = polygon[k];
    const std::uint32_t to = polygon[(k + 1) % polygon.size()];
    const glm::dvec3& a = surface.positions[from];
    const glm::dvec3 way = surface.positions[to] - a;
    const double length = glm::length(way);
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

void append_triangles(const std::vector<std::uint32_t>& polygon, SurfaceMesh& surface) {
  if (polygon.size() == 3) {
    surface.triangles.emplace_back(polygon[0], polygon[1], polygon[2]);
    return;
  }
  // A fan from the middle, so that corners in a line make no triangle without area.
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

/// True if along every edge as many triangles run in the one direction as in the other.
bool is_closed(const SurfaceMesh& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const glm::uvec3& t : surface.triangles) {
    for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)}) {
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return !surface.triangles.empty() &&
         std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

std::optional<SurfaceMesh> close_pieces(const std::vector<Polygon>& pieces, double same) {
  const double slack = kCornersApart * same;
  SurfaceMesh surface;
  Places places;
  std::vector<std::vector<std::uint32_t>> polygons;
  for (const Polygon& piece : pieces) {
    std::vector<std::uint32_t> rows;
    for (const glm::dvec3& corner : piece) {
      const std::uint32_t row = vertex_at(corner, slack, places, surface);
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
  std::ranges::sort(by_x, {}, [&surface](std::uint32_t row) { return surface.positions[row].x; });
  for (const std::vector<std::uint32_t>& polygon : polygons) {
    append_triangles(with_vertices_on_edges(polygon, by_x, surface, slack), surface);
  }
  if (!is_closed(surface)) {
    return std::nullopt;
  }
  return surface;
}

namespace {

// Of the mesh's size. Places nearer to each other than kSamePlace are the same; the two sides of a
// triangle are tested at this distance.
constexpr double kSamePlace = 1e-9;
constexpr double kBeside = 1e-7;

/// Triangles that share vertices.
struct Shells {
  std::vector<std::uint32_t> of_facet;
  std::uint32_t count = 0;
};

Shells find_shells(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const glm::uvec3& t : mesh.triangles) {
    link(parent, t.x, t.y);
    link(parent, t.x, t.z);
  }
  std::map<std::uint32_t, std::uint32_t> numbers;
  Shells shells;
  shells.of_facet.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) {
    const auto [number, is_new] = numbers.emplace(root_of(parent, t.x), shells.count);
    shells.count += is_new ? 1U : 0U;
    shells.of_facet.push_back(number->second);
  }
  return shells;
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

/// The facets of several shells.
struct Facets {
  std::vector<Facet> rows;
  std::vector<std::vector<std::uint32_t>> crossed_by;  // for each those of other shells
  double same = 0.0;                                   // m
  double beside = 0.0;                                 // m
};

void find_crossings(const Shells& shells, Facets& facets) {
  const std::vector<Facet>& rows = facets.rows;
  facets.crossed_by.assign(rows.size(), {});
  std::vector<std::uint32_t> order(rows.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {},
                    [&rows](std::uint32_t row) { return std::pair(rows[row].box.lowest.x, row); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t one = order[i];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const std::uint32_t other = order[j];
      if (rows[other].box.lowest.x > rows[one].box.highest.x + facets.same) {
        break;
      }
      if (shells.of_facet[one] != shells.of_facet[other] &&
          boxes_meet(rows[one].box, rows[other].box, facets.same) &&
          do_cross(rows[one], rows[other], facets.same)) {
        facets.crossed_by[one].push_back(other);
        facets.crossed_by[other].push_back(one);
      }
    }
  }
}

/// Facets that no other crosses are joined with their neighbours across edges to patches: each
/// patch is outside or inside as a whole.
/// @return for each facet the first one of its patch
std::vector<std::uint32_t> whole_patches(const SurfaceMesh& mesh, const Facets& facets) {
  std::vector<std::uint32_t> parent(facets.rows.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first;
  for (std::uint32_t row = 0; row < parent.size(); ++row) {
    const glm::uvec3& t = mesh.triangles[row];
    for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)}) {
      const auto [at, is_new] = first.emplace(std::minmax(a, b), row);
      if (!is_new && facets.crossed_by[row].empty() && facets.crossed_by[at->second].empty()) {
        link(parent, row, at->second);
      }
    }
  }
  for (std::uint32_t row = 0; row < parent.size(); ++row) {
    parent[row] = root_of(parent, row);
  }
  return parent;
}

/// Whether a piece of a facet bounds the solid.
/// @param point  m, of the piece
bool is_outside(const Facets& facets, std::uint32_t row, const glm::dvec3& point) {
  const Facet& facet = facets.rows[row];
  // Of coincident faces one is kept.
  for (const std::uint32_t other : facets.crossed_by[row]) {
    const Facet& crossing = facets.rows[other];
    if (other < row && glm::dot(crossing.normal, facet.normal) > 0.0 &&
        is_coplanar(facet, crossing, facets.same) && is_in(crossing, point)) {
      return false;
    }
  }
  return winding_number(facets.rows, point + facets.beside * facet.normal) < 0.5 &&
         winding_number(facets.rows, point - facets.beside * facet.normal) > 0.5;
}

/// The pieces that bound the solid: whole facets, and pieces of those that others cross.
std::vector<Polygon> outside_pieces(const Facets& facets, const std::vector<std::uint32_t>& patches,
                                    Union& united) {
  std::vector<Polygon> kept;
  std::vector<bool> outside(facets.rows.size());  // of patches, by their first facet
  for (std::uint32_t row = 0; row < facets.rows.size(); ++row) {
    const Facet& facet = facets.rows[row];
    std::vector<Polygon> pieces{Polygon(facet.corner.begin(), facet.corner.end())};
    if (facets.crossed_by[row].empty()) {
      if (patches[row] == row) {
        outside[row] = is_outside(facets, row, middle_of(pieces[0]));
      }
      if (outside[patches[row]]) {
        kept.push_back(std::move(pieces[0]));
      } else {
        united.buried += 1;
      }
      continue;
    }
    for (const std::uint32_t other : facets.crossed_by[row]) {
      cut_by(pieces, facet, facets.rows[other], facets.same);
    }
    united.cut += pieces.size() > 1 ? 1U : 0U;
    for (Polygon& piece : pieces) {
      if (is_outside(facets, row, middle_of(piece))) {
        kept.push_back(std::move(piece));
      }
    }
  }
  return kept;
}

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

/// Groups of mesh parts whose boxes meet.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<PartDescription>& parts) {
  std::vector<std::uint32_t> parent(parts.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto is_mesh = [&parts](std::size_t row) {
    return parts[row].shape.kind == ShapeKind::kMesh && !parts[row].surface.positions.empty();
  };
  std::vector<Bounds> boxes;
  boxes.reserve(parts.size());
  for (const PartDescription& part : parts) {
    boxes.push_back(bounds_of(part.surface.positions));
  }
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      if (is_mesh(i) && is_mesh(j) && boxes_meet(boxes[i], boxes[j], 0.0)) {
        link(parent, i, j);
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
  const Shells shells = find_shells(mesh);
  if (shells.count < 2) {
    return united;
  }
  const Bounds box = bounds_of(mesh.positions);
  const double size = glm::distance(box.lowest, box.highest);
  Facets facets{facets_of(mesh), {}, kSamePlace * size, kBeside * size};
  find_crossings(shells, facets);
  const std::vector<Polygon> kept = outside_pieces(facets, whole_patches(mesh, facets), united);
  united.changed = united.buried + united.cut > 0;
  if (!united.changed) {
    return united;
  }
  std::optional<SurfaceMesh> surface = close_pieces(kept, facets.same);
  if (!surface) {
    return Error{
        "its meshes overlap or touch, and their union could not be found: join them in a modeller "
        "(Blender: boolean modifier, union), or let them overlap by more"};
  }
  united.surface = *std::move(surface);
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

}  // namespace torsion::engine
