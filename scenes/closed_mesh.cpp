#include "scenes/closed_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

/// Vertices nearer to each other than this share of the mesh's size are one.
constexpr double kWeldShare = 1e-7;

using Edge = std::array<std::uint32_t, 2>;  // lower row first

/// How often the triangles run along an edge, with and against its order.
struct EdgeUse {
  std::uint32_t forth = 0;
  std::uint32_t back = 0;
};

std::string place_text(const glm::dvec3& p) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.6g, %.6g, %.6g)", p.x, p.y, p.z);
  return text.data();
}

glm::dvec3 size_of(const SurfaceMesh& mesh) {
  glm::dvec3 lowest(1e300);
  glm::dvec3 highest(-1e300);
  for (const glm::dvec3& position : mesh.positions) {
    lowest = glm::min(lowest, position);
    highest = glm::max(highest, position);
  }
  return highest - lowest;
}

/// Which cell of a grid a place lies in. Cells are much wider than the tolerance, so that few
/// vertices have more than their own to search; without a tolerance every place is a cell of its
/// own.
std::array<double, 3> cell_of(const glm::dvec3& p, double tolerance) {
  const double width = 8.0 * tolerance;
  return tolerance > 0.0
             ? std::array{std::floor(p.x / width), std::floor(p.y / width), std::floor(p.z / width)}
             : std::array{p.x, p.y, p.z};
}

struct CellVertex {
  std::array<double, 3> cell{};
  std::uint32_t row = 0;
};

/// Vertices in the order of their cells, so that those of one cell are found by bisection.
std::vector<CellVertex> vertices_by_cell(const SurfaceMesh& mesh, double tolerance) {
  std::vector<CellVertex> sorted(mesh.positions.size());
  for (std::uint32_t row = 0; row < sorted.size(); ++row) {
    sorted[row] = {cell_of(mesh.positions[row], tolerance), row};
  }
  std::ranges::sort(sorted, [](const CellVertex& a, const CellVertex& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.row < b.row;
  });
  return sorted;
}

/// The cells that a ball of the tolerance around `p` touches, mostly one.
std::vector<std::array<double, 3>> cells_near(const glm::dvec3& p, double tolerance) {
  std::vector<std::array<double, 3>> cells = {cell_of(p - glm::dvec3(tolerance), tolerance)};
  if (cells[0] == cell_of(p + glm::dvec3(tolerance), tolerance)) {
    return cells;
  }
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                          (corner & 4) != 0 ? 1.0 : -1.0);
    const auto cell = cell_of(p + tolerance * side, tolerance);
    if (std::ranges::find(cells, cell) == cells.end()) {
      cells.push_back(cell);
    }
  }
  return cells;
}

/// For each vertex the first one at its place.
std::vector<std::uint32_t> first_at_place(const SurfaceMesh& mesh, double tolerance) {
  const std::vector<CellVertex> sorted = vertices_by_cell(mesh, tolerance);
  std::vector<std::uint32_t> first(mesh.positions.size());
  for (std::uint32_t row = 0; row < first.size(); ++row) {
    const glm::dvec3& position = mesh.positions[row];
    std::uint32_t nearest = row;
    for (const auto& cell : cells_near(position, tolerance)) {
      auto other = std::ranges::lower_bound(sorted, cell, {}, &CellVertex::cell);
      for (; other != sorted.end() && other->cell == cell && other->row < nearest; ++other) {
        if (glm::distance(position, mesh.positions[other->row]) <= tolerance) {
          nearest = other->row;
        }
      }
    }
    first[row] = nearest == row ? row : first[nearest];
  }
  return first;
}

struct UsedEdge {
  Edge edge{};
  EdgeUse use;
};

/// Every edge once, in the order of its vertices.
std::vector<UsedEdge> edges_of(const SurfaceMesh& mesh) {
  std::vector<UsedEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = triangle[i];
      const std::uint32_t to = triangle[(i + 1) % 3];
      const bool forth = from < to;
      edges.push_back(
          {{std::min(from, to), std::max(from, to)}, {forth ? 1U : 0U, forth ? 0U : 1U}});
    }
  }
  std::ranges::sort(edges, {}, &UsedEdge::edge);
  std::size_t last = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].edge == edges[last].edge) {
      edges[last].use.forth += edges[i].use.forth;
      edges[last].use.back += edges[i].use.back;
    } else {
      edges[++last] = edges[i];
    }
  }
  edges.resize(std::min(edges.size(), last + 1));
  return edges;
}

/// One message for all edges with the same fault, with the place of the first.
struct EdgeFault {
  std::size_t count = 0;
  std::optional<Edge> first;
  void note(const Edge& edge) {
    count += 1;
    first = first ? first : edge;
  }
  void report(const SurfaceMesh& mesh, const std::string& where, const std::string& what,
              const std::string& mend, const ProblemList& problems) const {
    if (first) {
      problems.add(where, "mesh", "",
                   what + ": " + std::to_string(count) + " edges, one from " +
                       place_text(mesh.positions[(*first)[0]]) + " to " +
                       place_text(mesh.positions[(*first)[1]]) + " m in the node's frame",
                   mend);
    }
  }
};

bool report_edges(const SurfaceMesh& mesh, const std::string& where, const ProblemList& problems) {
  EdgeFault open;
  EdgeFault crowded;
  EdgeFault twisted;
  for (const auto& [edge, use] : edges_of(mesh)) {
    const std::uint32_t total = use.forth + use.back;
    if (total == 1) {
      open.note(edge);
    } else if (total % 2 != 0 || total > 2) {
      crowded.note(edge);
    } else if (use.forth != use.back) {
      twisted.note(edge);
    }
  }
  open.report(mesh, where, "is open, a solid has no holes",
              "close the hole (Blender: Mesh > Clean Up > Fill Holes), or set torsion_shape to an "
              "exact shape",
              problems);
  crowded.report(mesh, where, "has edges of more than two triangles, it bounds no solid",
                 "remove inner faces (Blender: Select > All by Trait > Non Manifold), or split it "
                 "into several nodes",
                 problems);
  twisted.report(mesh, where, "has neighbouring triangles that face opposite ways",
                 "recalculate the normals to the outside (Blender: Mesh > Normals)", problems);
  return !open.first && !crowded.first && !twisted.first;
}

}  // namespace

SurfaceMesh weld(const SurfaceMesh& mesh, double tolerance) {
  const std::vector<std::uint32_t> first = first_at_place(mesh, tolerance);
  SurfaceMesh welded;
  std::vector<std::uint32_t> row(first.size(), UINT32_MAX);
  for (const glm::uvec3& triangle : mesh.triangles) {
    glm::uvec3 corners(first[triangle.x], first[triangle.y], first[triangle.z]);
    if (corners.x == corners.y || corners.y == corners.z || corners.z == corners.x) {
      continue;
    }
    for (int i = 0; i < 3; ++i) {
      std::uint32_t& used = row[corners[i]];
      if (used == UINT32_MAX) {
        used = static_cast<std::uint32_t>(welded.positions.size());
        welded.positions.push_back(mesh.positions[corners[i]]);
      }
      corners[i] = used;
    }
    welded.triangles.push_back(corners);
  }
  return welded;
}

double enclosed_volume(const SurfaceMesh& mesh) {
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    volume += glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z]));
  }
  return volume / 6.0;
}

SurfaceMesh closed_surface(const SurfaceMesh& mesh, const std::string& where,
                           const ProblemList& problems) {
  const glm::dvec3 size = size_of(mesh);
  const double longest = std::max({size.x, size.y, size.z});
  SurfaceMesh welded = weld(mesh, kWeldShare * longest);
  if (welded.triangles.empty()) {
    problems.add(where, "mesh", "", "has no triangle with an area",
                 "check the scale of the node and the mesh");
    return welded;
  }
  if (!report_edges(welded, where, problems)) {
    return welded;
  }
  const double volume = enclosed_volume(welded);
  if (!(std::abs(volume) > 1e-9 * longest * longest * longest)) {
    problems.add(where, "mesh", "", "encloses no volume", "give it a thickness");
  } else if (volume < 0.0) {
    for (glm::uvec3& triangle : welded.triangles) {
      std::swap(triangle.y, triangle.z);
    }
  }
  return welded;
}

}  // namespace torsion::engine
