#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "systems/body_models/smooth_compliance.hpp"

namespace torsion {
namespace {

using std::numbers::pi;

constexpr double kCandidateCells = 28.0;  // along the longest side: some thousands on the surface

/// Points spread over a surface.
struct SurfacePoints {
  std::vector<Port> free;
  std::vector<glm::dvec3> clamped;  // m
  double area = 0.0;                // m^2, of both, roughly
};

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

/// The nearest surface point of each lattice cell that the surface goes through.
SurfacePoints sample_surface(const ElasticSolid& solid) {
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double size = std::max({extent.x, extent.y, extent.z}) / kCandidateCells;
  // Odd: a symmetric body has candidates in its middle planes.
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
        // the share of the cell's section that the surface is
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

/// Whether the surface stays near the port's plane as far as `reach` around it.
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

/// The end of the middle line that goes from the clamp through the body: where contacts are
/// likeliest.
std::size_t far_end(const Bounds& bounds, const std::vector<Port>& candidates,
                    const std::vector<glm::dvec3>& clamped) {
  if (clamped.empty()) {
    return 0;
  }
  glm::dvec3 root(0.0);
  for (const glm::dvec3& point : clamped) {
    root += point / static_cast<double>(clamped.size());
  }
  const glm::dvec3 line = 0.5 * (bounds.lowest + bounds.highest) - root;
  if (glm::length(line) < 1e-6 * glm::length(bounds.highest - bounds.lowest)) {
    return 0;
  }
  const glm::dvec3 axis = glm::normalize(line);
  const auto rank = [&](const Port& port) {
    const glm::dvec3 offset = port.position - root;
    const double along = glm::dot(offset, axis);
    return along - 2.0 * glm::length(offset - along * axis);
  };
  return static_cast<std::size_t>(
      std::max_element(candidates.begin(), candidates.end(),
                       [&](const Port& a, const Port& b) { return rank(a) < rank(b); }) -
      candidates.begin());
}

/// The planes through the middle of the bounds, across x, y and z, in which the body and its clamp
/// are their own mirror images.
struct Mirrors {
  glm::dvec3 middle{0.0};
  glm::bvec3 across{false};
};

Port mirrored(const Port& port, const glm::dvec3& middle, int axis) {
  Port image = port;
  image.position[axis] = 2.0 * middle[axis] - port.position[axis];
  image.normal[axis] = -port.normal[axis];
  return image;
}

Mirrors find_mirrors(const ElasticSolid& solid, const SurfacePoints& points) {
  constexpr double kSame = 1e-7;  // of the bounds' diagonal
  const double near = kSame * glm::length(solid.bounds.highest - solid.bounds.lowest);
  Mirrors mirrors{0.5 * (solid.bounds.lowest + solid.bounds.highest), glm::bvec3(true)};
  for (int axis = 0; axis < 3; ++axis) {
    const auto stays = [&](const Port& port, bool clamped) {
      const glm::dvec3 image = mirrored(port, mirrors.middle, axis).position;
      return std::abs(solid.signed_distance(image).value) < near && solid.clamped(image) == clamped;
    };
    mirrors.across[axis] =
        std::ranges::all_of(points.free, [&](const Port& port) { return stays(port, false); }) &&
        std::ranges::all_of(points.clamped, [&](const glm::dvec3& point) {
          return stays({point, {}}, true);
        });
  }
  return mirrors;
}

/// The port and its mirror images, each once.
std::vector<Port> images_of(const Port& port, const Mirrors& mirrors) {
  std::vector<Port> images{port};
  for (int axis = 0; axis < 3; ++axis) {
    if (mirrors.across[axis] && port.position[axis] != mirrors.middle[axis]) {
      const std::size_t count = images.size();
      for (std::size_t k = 0; k < count; ++k) {
        images.push_back(mirrored(images[k], mirrors.middle, axis));
      }
    }
  }
  return images;
}

/// How far a port is from the nearest of its own images, m.
double to_own_images(const Port& port, const Mirrors& mirrors) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double away = 2.0 * std::abs(port.position[axis] - mirrors.middle[axis]);
    if (mirrors.across[axis] && away > 0.0) {
      nearest = std::min(nearest, away);
    }
  }
  return nearest;
}

/// A candidate next to a middle plane, but for rounding in it, is put there.
void center(const Mirrors& mirrors, double spacing, std::vector<Port>& candidates) {
  constexpr double kRounding = 1e-6;
  for (Port& port : candidates) {
    for (int axis = 0; axis < 3; ++axis) {
      if (mirrors.across[axis] &&
          std::abs(port.position[axis] - mirrors.middle[axis]) < kRounding * spacing) {
        port.position[axis] = mirrors.middle[axis];
        port.normal[axis] = 0.0;
      }
    }
  }
}

/// A ball where ports are densest.
struct Focus {
  glm::dvec3 center{0.0};  // m, body
  double radius = 0.0;     // m
};

/// How far apart ports are to be at each candidate, over how far in the focus.
/// @param reach  m: beyond the focus, until it is the largest
std::vector<double> wanted_sizes(const std::vector<Port>& candidates, const Focus& focus,
                                 double reach) {
  constexpr double kLargest = 2.5;
  std::vector<double> sizes(candidates.size());
  std::transform(candidates.begin(), candidates.end(), sizes.begin(), [&](const Port& port) {
    const double beyond =
        std::min(reach, glm::distance(port.position, focus.center) - focus.radius);
    return 1.0 + (kLargest - 1.0) * std::max(beyond, 0.0) / reach;
  });
  return sizes;
}

}  // namespace

std::vector<Port> choose_ports(const ElasticSolid& solid, std::uint32_t count) {
  const SurfacePoints points = sample_surface(solid);
  const double spacing = std::sqrt(points.area / std::max(count, 1U));
  std::vector<Port> candidates;
  double inset = spacing / 3.0;
  for (int tries = 0; tries < 4 && candidates.size() < count; ++tries, inset *= 0.5) {
    candidates.clear();
    std::copy_if(points.free.begin(), points.free.end(), std::back_inserter(candidates),
                 [&](const Port& port) { return is_smooth(solid, port, inset); });
  }
  std::vector<Port> ports;
  if (candidates.empty() || count == 0) {
    return ports;
  }
  const Mirrors mirrors = find_mirrors(solid, points);
  center(mirrors, spacing, candidates);
  std::size_t next = far_end(solid.bounds, candidates, points.clamped);
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const Focus end{candidates[next].position, 0.5 * std::min({extent.x, extent.y, extent.z})};
  const std::vector<double> sizes = wanted_sizes(candidates, end, 2.0 * end.radius);
  std::vector<double> nearest(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    nearest[i] = to_own_images(candidates[i], mirrors) / sizes[i];
  }
  const auto keep_away = [&](const glm::dvec3& from) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      nearest[i] = std::min(nearest[i], glm::distance(candidates[i].position, from) / sizes[i]);
    }
  };
  std::for_each(points.clamped.begin(), points.clamped.end(), keep_away);
  while (nearest[next] > 0.05 * spacing || ports.empty()) {
    const std::vector<Port> images = images_of(candidates[next], mirrors);
    if (ports.size() + images.size() > count && !ports.empty()) {
      break;
    }
    for (const Port& image : images) {
      ports.push_back(image);
      keep_away(image.position);
    }
    next = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) -
                                    nearest.begin());
  }
  return ports;
}

}  // namespace torsion
