#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/body_models/footing.hpp"
#include "systems/body_models/smooth_compliance.hpp"
#include "systems/body_models/solid_surface.hpp"

namespace torsion {
namespace {

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
/// @param reach    m: beyond the focus, until it is the largest
/// @param largest  of them
std::vector<double> wanted_sizes(const std::vector<Port>& candidates, const Focus& focus,
                                 double reach, double largest) {
  std::vector<double> sizes(candidates.size());
  std::transform(candidates.begin(), candidates.end(), sizes.begin(), [&](const Port& port) {
    const double beyond =
        std::min(reach, glm::distance(port.position, focus.center) - focus.radius);
    return 1.0 + (largest - 1.0) * std::max(beyond, 0.0) / reach;
  });
  return sizes;
}

/// Where ports are to be densest, and by how much.
struct Density {
  Focus focus;
  double reach = 0.0;    // m
  double largest = 2.5;  // times as far apart at the most as in the focus
};

std::size_t nearest_to(const std::vector<Port>& ports, const glm::dvec3& point) {
  return static_cast<std::size_t>(
      std::ranges::min_element(
          ports, {}, [&](const Port& port) { return glm::distance(port.position, point); }) -
      ports.begin());
}

/// At the end opposite of the clamp.
Density usual_density(const ElasticSolid& solid, const std::vector<Port>& candidates,
                      const SurfacePoints& points) {
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double half = 0.5 * std::min({extent.x, extent.y, extent.z});
  const std::size_t end = far_end(solid.bounds, candidates, points.clamped);
  return {{candidates[end].position, half}, 2.0 * half};
}

/// On thin walls, where contacts are expected.
/// @param wall  m, thickness
Density density_on_walls(const ExpectedPlace& expected, double wall) {
  return {{expected.center, expected.radius + 2.0 * wall}, 4.0 * wall, 6.0};
}

/// Candidates and their mirror images, each next one farthest from all before it and from the
/// clamp, in distances over what is wanted there.
void choose_spread(const std::vector<Port>& candidates, const Mirrors& mirrors,
                   const std::vector<glm::dvec3>& clamped, const Density& density, double spacing,
                   std::size_t count, std::vector<Port>& ports) {
  const std::vector<double> sizes =
      wanted_sizes(candidates, density.focus, density.reach, density.largest);
  std::vector<double> nearest(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    nearest[i] = to_own_images(candidates[i], mirrors) / sizes[i];
  }
  const auto keep_away = [&](const glm::dvec3& from) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      nearest[i] = std::min(nearest[i], glm::distance(candidates[i].position, from) / sizes[i]);
    }
  };
  std::ranges::for_each(clamped, keep_away);
  std::size_t next = nearest_to(candidates, density.focus.center);
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
}

/// Ports for faces that have none of their own, such as the narrow rim of a tube: the point from
/// which the nearest port is seen farthest over `reach`, again and again, until none is beyond it.
/// @param points  m, of the free surface
/// @param reach   m, of each
/// @param most    how many
void add_seen_ports(const std::vector<Port>& points, const std::vector<double>& reach,
                    std::size_t most, std::vector<Port>& ports) {
  std::vector<double> beyond(points.size(), kNeverSeen);
  const auto see = [&](const Port& port) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double seen =
          seen_distance({port.position, port.normal}, points[i].position, points[i].normal);
      beyond[i] = std::min(beyond[i], seen / reach[i]);
    }
  };
  std::ranges::for_each(ports, see);
  for (std::size_t added = 0; added < most && !points.empty(); ++added) {
    const auto farthest = std::ranges::max_element(beyond);
    if (*farthest <= 1.0) {
      break;
    }
    ports.push_back(points[static_cast<std::size_t>(farthest - beyond.begin())]);
    see(ports.back());
  }
}

/// Farther than any point of a face with ports is from the nearest (measured: 2.5 spacings).
constexpr double kWithoutPorts = 3.0;
constexpr double kApartOnWalls = 0.6;  // of a wall's thickness, where contacts are expected

/// How far from the nearest port each point may be, m.
std::vector<double> seen_reach(const std::vector<Port>& points, const Focus* walls, double wall,
                               double spacing) {
  std::vector<double> reach(points.size(), kWithoutPorts * spacing);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (walls != nullptr && glm::distance(points[i].position, walls->center) < walls->radius) {
      reach[i] = kApartOnWalls * wall;
    }
  }
  return reach;
}

}  // namespace

std::vector<Port> choose_ports(const ElasticSolid& solid, std::uint32_t count,
                               const ExpectedPlace& expected) {
  SurfacePoints points = sample_solid_surface(solid);
  const double spacing = std::sqrt(points.area / std::max(count, 1U));
  const double wall = wall_thickness(solid, points);
  const bool on_walls = expected.known && wall < spacing;
  if (on_walls) {
    const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
    const double longest = std::max({extent.x, extent.y, extent.z});
    points = sample_solid_surface(solid, std::clamp(4.0 * longest / wall, 28.0, 56.0));
  }
  std::vector<Port> candidates;
  double inset = (on_walls ? std::min(wall, spacing) : spacing) / 3.0;
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
  const Density density =
      on_walls ? density_on_walls(expected, wall) : usual_density(solid, candidates, points);
  choose_spread(candidates, mirrors, points.clamped, density, spacing, count, ports);
  add_seen_ports(points.free,
                 seen_reach(points.free, on_walls ? &density.focus : nullptr, wall, spacing), count,
                 ports);
  return ports;
}

double port_distance_over_thickness(const ElasticSolid& solid, std::span<const Port> ports,
                                    const ExpectedPlace& expected) {
  const SurfacePoints points = sample_solid_surface(solid);
  std::vector<double> shares;
  for (const Port& point : points.free) {
    const double thickness = thickness_at(solid, point);
    if (expected.known &&
        glm::distance(point.position, expected.center) > expected.radius + thickness) {
      continue;
    }
    double nearest = kNeverSeen;
    for (const Port& port : ports) {
      nearest = std::min(nearest,
                         seen_distance({port.position, port.normal}, point.position, point.normal));
    }
    shares.push_back(nearest / thickness);
  }
  if (shares.empty()) {
    return 0.0;
  }
  const auto at =
      shares.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(shares.size()));
  std::nth_element(shares.begin(), at, shares.end());
  return *at;
}

}  // namespace torsion
