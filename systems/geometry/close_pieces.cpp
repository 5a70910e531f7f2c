#include "systems/geometry/close_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace torsion {
namespace {

constexpr double kCornersApart = 8.0;  // of what is the same: a corner is found from two sides

/// Vertices by the cell of a grid that they lie in.
using Places = std::map<std::array<double, 3>, std::vector<std::uint32_t>>;

/// The row of a vertex there, which is new if there was none.
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

/// True where along every edge as many triangles run forth as back.
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

}  // namespace torsion
