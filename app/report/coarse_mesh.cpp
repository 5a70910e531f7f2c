#include "app/report/coarse_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <glm/geometric.hpp>

#include "render/box.hpp"

namespace torsion::engine {
namespace {

/// What vertices that become one have in common.
using Cluster = std::array<long, 5>;

/// Which side of a cube the normal points to: 0 to 5.
long side_of(const glm::vec3& normal) {
  long axis = 0;
  for (int i = 1; i < 3; ++i) {
    axis = std::abs(normal[i]) > std::abs(normal[static_cast<int>(axis)]) ? i : axis;
  }
  return 2 * axis + (normal[static_cast<int>(axis)] < 0.0F ? 1 : 0);
}

/// Whether every face has a normal of its own, and so edges that are to stay.
bool is_flat_shaded(const DrawMesh& mesh) {
  return std::ranges::all_of(mesh.triangles, [&](const glm::uvec3& t) {
    return mesh.normals[t.x] == mesh.normals[t.y] && mesh.normals[t.x] == mesh.normals[t.z];
  });
}

}  // namespace

DrawMesh coarse_mesh(const DrawMesh& mesh, const glm::vec3& center, float fine, float cell) {
  constexpr float kSamePlace = 1e-3F;  // of a cell
  const bool flat = is_flat_shaded(mesh);
  const glm::vec3 middle(box_of(mesh.positions).center());
  std::map<Cluster, std::uint32_t> rows;
  std::vector<std::uint32_t> row_of;
  std::vector<float> members;
  DrawMesh coarse;
  coarse.materials = mesh.materials;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& position = mesh.positions[i];
    const glm::vec3 from = position - center;
    const bool near = glm::length(from) <= fine;
    const glm::vec3 at = from / (near ? kSamePlace * cell : cell);
    const auto [entry, fresh] =
        rows.try_emplace({std::lround(at.x), std::lround(at.y), std::lround(at.z),
                          flat ? side_of(mesh.normals[i]) : 0, near ? 1 : 0},
                         static_cast<std::uint32_t>(rows.size()));
    const std::uint32_t row = entry->second;
    row_of.push_back(row);
    if (fresh) {
      coarse.positions.push_back(position);
      coarse.normals.push_back(mesh.normals[i]);
      members.push_back(1.0F);
      if (!mesh.fixed.empty()) {
        coarse.fixed.push_back(mesh.fixed[i]);
      }
    } else if (!flat) {  // the mean, which is smooth
      members[row] += 1.0F;
      coarse.positions[row] += (position - coarse.positions[row]) / members[row];
      coarse.normals[row] = glm::normalize(coarse.normals[row] + mesh.normals[i]);
    } else if (glm::distance(position, middle) > glm::distance(coarse.positions[row], middle)) {
      coarse.positions[row] = position;  // the outermost, so that no corner is cut
    }
  }
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::uvec3 rows_now(row_of[t.x], row_of[t.y], row_of[t.z]);
    if (rows_now.x != rows_now.y && rows_now.y != rows_now.z && rows_now.z != rows_now.x) {
      coarse.triangles.push_back(rows_now);
    }
  }
  return coarse;
}

}  // namespace torsion::engine
