#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "systems/model/finite_elements/grid.hpp"

namespace torsion::engine {
namespace {

/// A clamped node that is this near to the clamp's end stays: the search for a face's nodes allows
/// for rounding.
constexpr double kAtEnd = 0.01;  // of an edge

/// The place that a node moves to: the end of the clamp on one of its edges.
struct Target {
  glm::dvec3 position{0.0};                                   // m
  double distance = std::numeric_limits<double>::infinity();  // m
};

/// The clamp's last point on the way from a clamped point to a free one.
glm::dvec3 end_of_clamp(const ElasticSolid& solid, glm::dvec3 clamped, glm::dvec3 free) {
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const glm::dvec3 middle = 0.5 * (clamped + free);
    (solid.clamped(middle) ? clamped : free) = middle;
  }
  return clamped;
}

std::vector<std::uint8_t> surface_nodes(const SolidGrid& grid) {
  std::vector<std::uint8_t> on_surface(grid.nodes.size(), 0);
  for (const std::array<std::uint32_t, 4>& face : grid.faces) {
    for (const std::uint32_t node : face) {
      on_surface[node] = 1;
    }
  }
  return on_surface;
}

/// The nearest target of each node that has one. Free nodes: in the half of an edge towards the
/// clamp; clamped nodes: anywhere on it. Nodes of the surface move along the surface only.
std::vector<Target> find_targets(const ElasticSolid& solid, const SolidGrid& grid,
                                 const std::vector<std::uint8_t>& on_surface, bool of_free) {
  std::vector<Target> targets(grid.nodes.size());
  for (const std::array<std::uint32_t, 8>& element : grid.elements) {
    for (std::uint32_t c = 0; c < 8; ++c) {
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t held = element[c];
        const std::uint32_t free = element[c ^ 1U << axis];
        const std::uint32_t moved = of_free ? free : held;
        if (grid.clamped[held] == 0 || grid.clamped[free] != 0 ||
            (on_surface[moved] != 0 && on_surface[of_free ? held : free] == 0)) {
          continue;
        }
        const glm::dvec3& from = grid.nodes[held];
        const glm::dvec3& to = grid.nodes[free];
        const glm::dvec3 end = end_of_clamp(solid, from, to);
        const double distance = glm::distance(end, grid.nodes[moved]);
        const double edge = glm::distance(from, to);
        if (distance < targets[moved].distance &&
            (of_free ? distance < 0.5 * edge : distance > kAtEnd * edge)) {
          targets[moved] = {end, distance};
        }
      }
    }
  }
  return targets;
}

/// Moves the nodes that have a target and marks them as clamped.
void move_nodes(const ElasticSolid& solid, const std::vector<Target>& targets,
                const std::vector<std::uint8_t>& on_surface, SolidGrid& grid) {
  for (std::size_t node = 0; node < targets.size(); ++node) {
    if (targets[node].distance == std::numeric_limits<double>::infinity()) {
      continue;
    }
    grid.nodes[node] = targets[node].position;
    grid.clamped[node] = 1;
    if (on_surface[node] != 0) {
      const Distance distance = solid.signed_distance(grid.nodes[node]);
      grid.nodes[node] -= distance.gradient * distance.value;
    }
  }
}

}  // namespace

void fit_clamp(const ElasticSolid& solid, SolidGrid& grid) {
  grid.clamped.clear();
  for (const glm::dvec3& node : grid.nodes) {
    grid.clamped.push_back(static_cast<std::uint8_t>(solid.clamped(node) ? 1 : 0));
  }
  const std::vector<glm::dvec3> nodes = grid.nodes;
  const std::vector<std::uint8_t> clamped = grid.clamped;
  const std::vector<std::uint8_t> on_surface = surface_nodes(grid);
  move_nodes(solid, find_targets(solid, grid, on_surface, true), on_surface, grid);
  move_nodes(solid, find_targets(solid, grid, on_surface, false), on_surface, grid);
  // Moves nodes back where that would squash an element that could still deform.
  bool all_sound = false;
  while (!all_sound) {
    all_sound = true;
    for (std::size_t e = 0; e < grid.elements.size(); ++e) {
      if (is_sound(grid, e)) {
        continue;
      }
      for (const std::uint32_t node : grid.elements[e]) {
        all_sound = all_sound && grid.nodes[node] == nodes[node];
        grid.nodes[node] = nodes[node];
        grid.clamped[node] = clamped[node];
      }
    }
  }
}

}  // namespace torsion::engine
