#include "scenes/closed_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>

namespace torsion {
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

/// For each vertex the first one at its place: sorted along x, only near ones are compared.
std::vector<std::uint32_t> first_at_place(const SurfaceMesh& mesh, double tolerance) {
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  const auto& positions = mesh.positions;
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const glm::dvec3& p = positions[a];
    const glm::dvec3& q = positions[b];
    return std::array{p.x, p.y, p.z, static_cast<double>(a)} <
           std::array{q.x, q.y, q.z, static_cast<double>(b)};
  });
  std::vector<std::uint32_t> first(count);
  std::iota(first.begin(), first.end(), 0U);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t self = order[i];
    for (std::uint32_t j = i; j-- > 0;) {
      const std::uint32_t other = order[j];
      if (positions[self].x - positions[other].x > tolerance) {
        break;
      }
      if (glm::distance(positions[self], positions[other]) <= tolerance) {
        first[self] = first[other];
        break;
      }
    }
  }
  return first;
}

std::map<Edge, EdgeUse> edges_of(const SurfaceMesh& mesh) {
  std::map<Edge, EdgeUse> edges;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = triangle[i];
      const std::uint32_t to = triangle[(i + 1) % 3];
      EdgeUse& use = edges[{std::min(from, to), std::max(from, to)}];
      (from < to ? use.forth : use.back) += 1;
    }
  }
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

}  // namespace torsion
