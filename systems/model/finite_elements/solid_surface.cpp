#include "systems/model/finite_elements/solid_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace torsion::engine {
namespace {

using std::numbers::pi;

std::optional<Port> on_surface(const ElasticSolid& solid, glm::dvec3 point, double reach) {
  Distance distance = solid.signed_distance(point);
  if (std::abs(distance.value) > reach) {
    return std::nullopt;
  }
  for (int i = 0; i < 4; ++i) {
    point -= distance.gradient * distance.value;
    distance = solid.signed_distance(point);
  }
  if (!(std::abs(distance.value) < 1e-2 * reach)) {
    return std::nullopt;
  }
  return Port{point, glm::normalize(distance.gradient)};
}

}  // namespace

SurfacePoints sample_solid_surface(const ElasticSolid& solid, double cells_along) {
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double size = std::max({extent.x, extent.y, extent.z}) / cells_along;
  // Odd numbers: a symmetric body has candidates in its middle planes.
  const glm::uvec3 cells = glm::uvec3(glm::max(glm::ceil(extent / size), glm::dvec3(6.0))) | 1U;
  const glm::dvec3 spacing = extent / glm::dvec3(cells);
  const double reach = 0.5 * glm::length(spacing);
  SurfacePoints points;
  for (std::uint32_t z = 0; z < cells.z; ++z) {
    for (std::uint32_t y = 0; y < cells.y; ++y) {
      for (std::uint32_t x = 0; x < cells.x; ++x) {
        const glm::dvec3 cell(x, y, z);
        const glm::dvec3 center = solid.bounds.lowest + spacing * (cell + glm::dvec3(0.5));
        const std::optional<Port> port = on_surface(solid, center, reach);
        if (!port || glm::any(glm::greaterThan(glm::abs(port->position - center),
                                               glm::dvec3(0.5 + 1e-9) * spacing))) {
          continue;
        }
        // The share of the cell's section that the surface makes up.
        const glm::dvec3 n = glm::abs(port->normal);
        points.area += spacing.x * spacing.y * spacing.z /
                       std::max({n.x * spacing.x, n.y * spacing.y, n.z * spacing.z});
        if (solid.clamped(port->position)) {
          points.clamped.push_back(port->position);
        } else {
          points.free.push_back(*port);
        }
      }
    }
  }
  return points;
}

bool is_smooth(const ElasticSolid& solid, const Port& port, double reach) {
  constexpr int kDirections = 8;
  const glm::dvec3 other =
      std::abs(port.normal.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 first = glm::normalize(glm::cross(port.normal, other));
  const glm::dvec3 second = glm::cross(port.normal, first);
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * pi * k / kDirections;
    const Distance distance = solid.signed_distance(
        port.position + reach * (std::cos(angle) * first + std::sin(angle) * second));
    if (glm::dot(distance.gradient, port.normal) < 0.6 || std::abs(distance.value) > 0.5 * reach) {
      return false;
    }
  }
  return true;
}

double wall_thickness(const ElasticSolid& solid, const SurfacePoints& points) {
  constexpr double kShare = 0.1;
  std::vector<double> ways;
  for (const Port& port : points.free) {
    ways.push_back(thickness_at(solid, port));
  }
  if (ways.empty()) {
    return 0.0;
  }
  const auto at =
      ways.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(ways.size()));
  std::nth_element(ways.begin(), at, ways.end());
  return *at;
}

double thickness_at(const ElasticSolid& solid, const Port& port) {
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double longest = std::max({extent.x, extent.y, extent.z});
  const double shortest_step = 2e-3 * longest;
  double way = shortest_step;
  while (way < 2.0 * longest) {
    const double depth = -solid.signed_distance(port.position - way * port.normal).value;
    if (depth <= 0.0) {
      break;
    }
    way += std::max(depth, shortest_step);
  }
  return way;
}

std::vector<double> walls_at(const ElasticSolid& solid, std::span<const Port> points) {
  std::vector<double> thickness(points.size());
  std::ranges::transform(points, thickness.begin(),
                         [&](const Port& point) { return thickness_at(solid, point); });
  std::vector<double> walls = thickness;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (thickness[k] < walls[i] &&
          glm::distance(points[i].position, points[k].position) < thickness[k]) {
        walls[i] = thickness[k];
      }
    }
  }
  return walls;
}

}  // namespace torsion::engine
