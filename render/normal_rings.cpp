#include "render/normal_rings.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "shaders/shared.h"

namespace torsion::engine {
namespace {

/// Split vertices whose normals differ by less than this belong together: files round normals to 3
/// digits or more (1e-3 rad), while a surface meant to look faceted has a degree or more between
/// its faces.
constexpr float kSameNormalCosine = 0.99990F;  // 0.81 degrees

/// A triangle's corner: seen from `group`, the triangle spans the edge from one neighbour to the
/// next.
struct Corner {
  std::uint32_t group = 0;  // of the corner's vertex
  std::uint32_t from = 0;   // vertex
  std::uint32_t to = 0;     // vertex
};

/// For each vertex the first vertex at the same place, and the first at the same place with the
/// same normal.
struct Groups {
  std::vector<std::uint32_t> place;
  std::vector<std::uint32_t> normal;
};

Groups group_vertices(std::span<const VertexRest> rest, std::span<const VertexNormal> normals) {
  const auto key = [&](std::uint32_t vertex) {
    const glm::vec4& p = rest[vertex].position;
    return std::tuple(p.x, p.y, p.z, vertex);
  };
  std::vector<std::uint32_t> order(rest.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });

  Groups groups{std::vector<std::uint32_t>(rest.size()), std::vector<std::uint32_t>(rest.size())};
  std::vector<std::uint32_t> leaders;  // of the normal groups at the present place
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t vertex = order[i];
    const bool same_place =
        i > 0 && glm::vec3(rest[vertex].position) == glm::vec3(rest[order[i - 1]].position);
    if (!same_place) {
      leaders.clear();
    }
    groups.place[vertex] = same_place ? groups.place[order[i - 1]] : vertex;
    const auto leader = std::ranges::find_if(leaders, [&](std::uint32_t other) {
      return glm::dot(glm::vec3(normals[vertex].normal), glm::vec3(normals[other].normal)) >
             kSameNormalCosine;
    });
    groups.normal[vertex] = leader != leaders.end() ? *leader : vertex;
    if (leader == leaders.end()) {
      leaders.push_back(vertex);
    }
  }
  return groups;
}

std::vector<Corner> sorted_corners(std::span<const Triangle> triangles, const Groups& groups) {
  std::vector<Corner> corners;
  corners.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    const glm::uvec3& v = triangle.vertices;
    corners.push_back({groups.normal[v.x], v.y, v.z});
    corners.push_back({groups.normal[v.y], v.z, v.x});
    corners.push_back({groups.normal[v.z], v.x, v.y});
  }
  std::ranges::stable_sort(corners, {}, &Corner::group);
  return corners;
}

/// Strings the corners of one vertex into fans: each fan starts at an edge that no other edge leads
/// to (the rim of an open fan), or anywhere when it is closed. Non-manifold vertices merely get
/// more fans. Lookups are binary searches, since the tip of a cone may have many thousand corners.
class FanMaker {
 public:
  void append_fans(std::span<const Corner> corners, const Groups& groups,
                   std::vector<std::uint32_t>& entries) {
    by_start_.clear();
    ends_.clear();
    for (const Corner& corner : corners) {
      by_start_.push_back(
          {groups.place[corner.from], groups.place[corner.to], corner.from, corner.to, false});
      ends_.push_back(groups.place[corner.to]);
    }
    std::ranges::stable_sort(by_start_, {}, &Edge::from_place);
    std::ranges::sort(ends_);
    for (const bool open_fans : {true, false}) {
      for (Edge& start : by_start_) {
        if (!start.used && !(open_fans && std::ranges::binary_search(ends_, start.from_place))) {
          append_fan(start, entries);
        }
      }
    }
  }

 private:
  struct Edge {
    std::uint32_t from_place = 0;
    std::uint32_t to_place = 0;
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool used = false;
  };

  void append_fan(Edge& start, std::vector<std::uint32_t>& entries) {
    entries.push_back(start.from | shared::kRingRestart);
    for (Edge* edge = &start; edge != nullptr; edge = unused_from(edge->to_place)) {
      edge->used = true;
      entries.push_back(edge->to);
    }
  }

  Edge* unused_from(std::uint32_t place) {
    auto edge = std::ranges::lower_bound(by_start_, place, {}, &Edge::from_place);
    while (edge != by_start_.end() && edge->from_place == place && edge->used) {
      ++edge;
    }
    return edge != by_start_.end() && edge->from_place == place ? &*edge : nullptr;
  }

  std::vector<Edge> by_start_;
  std::vector<std::uint32_t> ends_;
};

void append_body(const FrameWorld& frame, std::uint32_t body, NormalRings& rings) {
  const auto& drawn = frame.bodies.at<DrawRange>(body);
  const Groups groups = group_vertices(frame.body_vertices.rows<VertexRest>(drawn.vertices),
                                       frame.body_vertices.rows<VertexNormal>(drawn.vertices));
  const std::vector<Corner> corners =
      sorted_corners(frame.body_triangles.rows<Triangle>(drawn.triangles), groups);
  const std::span<glm::uvec2> ranges =
      std::span(rings.ranges).subspan(drawn.vertices.first, drawn.vertices.count);
  FanMaker fans;
  for (std::size_t begin = 0; begin < corners.size();) {
    const std::uint32_t group = corners[begin].group;
    std::size_t end = begin;
    while (end < corners.size() && corners[end].group == group) {
      ++end;
    }
    const auto first = static_cast<std::uint32_t>(rings.entries.size());
    fans.append_fans(std::span(corners).subspan(begin, end - begin), groups, rings.entries);
    ranges[group] = {first, static_cast<std::uint32_t>(rings.entries.size()) - first};
    begin = end;
  }
  for (std::uint32_t vertex = 0; vertex < ranges.size(); ++vertex) {
    ranges[vertex] = ranges[groups.normal[vertex]];
  }
}

}  // namespace

NormalRings make_normal_rings(const FrameWorld& frame) {
  NormalRings rings;
  rings.ranges.resize(frame.body_vertices.size(), glm::uvec2(0));
  rings.entries.reserve(std::size_t{4} * frame.body_triangles.size());
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    append_body(frame, body, rings);
  }
  return rings;
}

void vertex_normals(const FrameWorld& frame, const NormalRings& rings, std::uint32_t body,
                    std::span<const glm::vec4> positions, std::span<glm::vec4> normals) {
  const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
  TORSION_ASSERT(positions.size() == vertices.count && normals.size() == vertices.count);
  const std::span<const VertexNormal> rest = frame.body_vertices.rows<VertexNormal>(vertices);
  for (std::uint32_t vertex = 0; vertex < vertices.count; ++vertex) {
    const glm::uvec2 range = rings.ranges[vertices.first + vertex];
    const glm::vec3 center(positions[vertex]);
    glm::vec3 sum(0.0F);
    glm::vec3 before(0.0F);
    for (std::uint32_t i = 0; i < range.y; ++i) {
      const std::uint32_t entry = rings.entries[range.x + i];
      const glm::vec3 edge = glm::vec3(positions[entry & shared::kRingVertex]) - center;
      if ((entry & shared::kRingRestart) == 0) {
        sum += glm::cross(before, edge);
      }
      before = edge;
    }
    const float square = glm::dot(sum, sum);
    normals[vertex] = square > 0.0F ? glm::vec4(sum / std::sqrt(square), 0.0F)
                                    : glm::vec4(glm::vec3(rest[vertex].normal), 0.0F);
  }
}

}  // namespace torsion::engine
