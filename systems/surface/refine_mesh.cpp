#include "systems/surface/refine_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

using EdgeKey = std::uint64_t;

EdgeKey edge_of(std::uint32_t a, std::uint32_t b) {
  return EdgeKey{std::min(a, b)} << 32U | std::max(a, b);
}

double distance_to(const Bounds& box, const glm::dvec3& point) {
  return glm::distance(point, glm::clamp(point, box.lowest, box.highest));
}

/// A mesh under way: its vertices, and which of them are at one place.
class Refinement {
 public:
  Refinement(DrawMesh& mesh, const DrawnDetail& detail, double coarser)
      : mesh_(mesh), detail_(detail), coarser_(coarser) {
    std::map<std::array<float, 3>, std::uint32_t> places;
    for (const glm::vec3& p : mesh_.positions) {
      place_.push_back(
          places.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(places.size()))
              .first->second);
    }
    next_place_ = static_cast<std::uint32_t>(places.size());
  }

  /// Cuts every triangle with an edge that is too long, once. @return whether there was one
  bool pass() {
    cut_.clear();
    middle_.clear();
    mark_long_edges();
    if (cut_.empty()) {
      return false;
    }
    mark_longest_of_cut();
    const std::vector<glm::uvec3> before = std::move(mesh_.triangles);
    const std::vector<std::uint32_t> materials = std::move(mesh_.triangle_materials);
    mesh_.triangles.clear();
    mesh_.triangle_materials.clear();
    for (std::size_t i = 0; i < before.size(); ++i) {
      split(before[i]);
      if (!materials.empty()) {
        mesh_.triangle_materials.resize(mesh_.triangles.size(), materials[i]);
      }
    }
    return true;
  }

 private:
  [[nodiscard]] glm::dvec3 at(std::uint32_t vertex) const {
    return glm::dvec3(mesh_.positions[vertex]);
  }
  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const {
    return glm::distance(at(a), at(b));
  }
  [[nodiscard]] EdgeKey key(std::uint32_t a, std::uint32_t b) const {
    return edge_of(place_[a], place_[b]);
  }
  [[nodiscard]] bool is_cut(std::uint32_t a, std::uint32_t b) const {
    return cut_.contains(key(a, b));
  }

  [[nodiscard]] bool too_long(std::uint32_t a, std::uint32_t b) const {
    double longest = detail_.everywhere;
    if (detail_.touched) {
      const double far =
          std::min({distance_to(detail_.where, at(a)), distance_to(detail_.where, at(b)),
                    distance_to(detail_.where, 0.5 * (at(a) + at(b)))});
      longest = std::min(longest, detail_.there + 0.5 * far);
    }
    return length(a, b) > coarser_ * longest;
  }

  void mark(std::uint32_t a, std::uint32_t b) {
    if (cut_.try_emplace(key(a, b), next_place_).second) {
      ++next_place_;
    }
  }

  void mark_long_edges() {
    for (const glm::uvec3& t : mesh_.triangles) {
      for (int i = 0; i < 3; ++i) {
        if (too_long(t[i], t[(i + 1) % 3])) {
          mark(t[i], t[(i + 1) % 3]);
        }
      }
    }
  }

  /// A triangle that is cut at all is cut at its longest edge; its neighbour there, too, and so on.
  void mark_longest_of_cut() {
    for (bool again = true; again;) {
      again = false;
      for (const glm::uvec3& t : mesh_.triangles) {
        const bool any = is_cut(t.x, t.y) || is_cut(t.y, t.z) || is_cut(t.z, t.x);
        const int i = longest_side(t);
        if (any && !is_cut(t[i], t[(i + 1) % 3])) {
          mark(t[i], t[(i + 1) % 3]);
          again = true;
        }
      }
    }
  }

  /// The corner at which the longest edge begins. Of edges as long as each other the one whose
  /// places come first, so that both sides agree.
  [[nodiscard]] int longest_side(const glm::uvec3& t) const {
    const auto rank = [&](int i) {
      return std::pair(length(t[i], t[(i + 1) % 3]), ~key(t[i], t[(i + 1) % 3]));
    };
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      longest = rank(i) > rank(longest) ? i : longest;
    }
    return longest;
  }

  /// The vertex in the middle of an edge that is cut.
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        middle_.try_emplace(edge_of(a, b), static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.push_back(0.5F * (mesh_.positions[a] + mesh_.positions[b]));
      if (!mesh_.normals.empty()) {
        const glm::vec3 sum = mesh_.normals[a] + mesh_.normals[b];
        const float size = glm::length(sum);
        mesh_.normals.push_back(size > 0.0F ? sum / size : mesh_.normals[a]);
      }
      if (!mesh_.texcoords.empty()) {
        mesh_.texcoords.push_back(0.5F * (mesh_.texcoords[a] + mesh_.texcoords[b]));
      }
      if (!mesh_.colors.empty()) {
        mesh_.colors.push_back(0.5F * (mesh_.colors[a] + mesh_.colors[b]));
      }
      if (!mesh_.fixed.empty()) {
        mesh_.fixed.push_back(mesh_.fixed[a] && mesh_.fixed[b]);
      }
      place_.push_back(cut_.at(key(a, b)));
    }
    return found->second;
  }

  void split(const glm::uvec3& triangle) {
    const int first = longest_side(triangle);
    const std::uint32_t a = triangle[first];
    const std::uint32_t b = triangle[(first + 1) % 3];
    const std::uint32_t c = triangle[(first + 2) % 3];
    std::vector<glm::uvec3>& out = mesh_.triangles;
    if (!is_cut(a, b)) {  // then no other edge is
      out.push_back(triangle);
      return;
    }
    const std::uint32_t ab = middle(a, b);
    if (is_cut(b, c)) {
      const std::uint32_t bc = middle(b, c);
      out.insert(out.end(), {{ab, b, bc}, {ab, bc, c}});
    } else {
      out.emplace_back(ab, b, c);
    }
    if (is_cut(c, a)) {
      const std::uint32_t ca = middle(c, a);
      out.insert(out.end(), {{ab, c, ca}, {ab, ca, a}});
    } else {
      out.emplace_back(ab, c, a);
    }
  }

  DrawMesh& mesh_;
  const DrawnDetail& detail_;
  double coarser_;
  std::vector<std::uint32_t> place_;  // (vertices)
  std::uint32_t next_place_ = 0;
  std::unordered_map<EdgeKey, std::uint32_t> cut_;     // edge of places -> place of its middle
  std::unordered_map<EdgeKey, std::uint32_t> middle_;  // edge of vertices -> vertex of its middle
};

/// @return whether it has no more triangles than it may
bool refine_once(DrawMesh& mesh, const DrawnDetail& detail, double coarser) {
  Refinement refinement(mesh, detail, coarser);
  while (mesh.triangles.size() <= detail.most_triangles && refinement.pass()) {
  }
  return mesh.triangles.size() <= detail.most_triangles;
}

}  // namespace

void refine_mesh(DrawMesh& mesh, const DrawnDetail& detail) {
  constexpr double kCoarser = 1.25;
  if (mesh.triangles.size() > detail.most_triangles) {
    return;
  }
  for (double coarser = 1.0;; coarser *= kCoarser) {
    DrawMesh refined = mesh;
    if (refine_once(refined, detail, coarser)) {
      mesh = std::move(refined);
      return;
    }
  }
}

}  // namespace torsion::engine
