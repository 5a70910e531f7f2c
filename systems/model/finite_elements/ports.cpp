#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/contact/support/support_fit.hpp"
#include "systems/model/finite_elements/compliance.hpp"
#include "systems/model/finite_elements/solid_surface.hpp"

namespace torsion::engine {
namespace {

/// The end of the line from the clamp through the middle of the body: where contacts are likeliest.
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

/// The distance between a port and its nearest mirror image, m.
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

/// Moves a candidate that is, but for rounding, in a middle plane into it.
void center(const Mirrors& mirrors, double spacing, std::vector<Port>& candidates) {
  constexpr double kSameSide = 1e-6;
  for (Port& port : candidates) {
    for (int axis = 0; axis < 3; ++axis) {
      if (mirrors.across[axis] &&
          std::abs(port.position[axis] - mirrors.middle[axis]) < kSameSide * spacing) {
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

/// The wanted distance of ports at each candidate, over the one in the focus.
/// @param reach    m: from the focus to where the distance is largest
/// @param largest  of these ratios
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

/// Where ports are densest, and by how much.
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

/// Densest at the end opposite to the clamp.
Density usual_density(const ElasticSolid& solid, const std::vector<Port>& candidates,
                      const SurfacePoints& points) {
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double half = 0.5 * std::min({extent.x, extent.y, extent.z});
  const std::size_t end = far_end(solid.bounds, candidates, points.clamped);
  return {{candidates[end].position, half}, 2.0 * half};
}

/// Densest on thin walls where contacts are expected.
/// @param wall  m, thickness
Density density_on_walls(const ExpectedPlace& expected, double wall) {
  return {{expected.center, expected.radius + 2.0 * wall}, 4.0 * wall, 6.0};
}

/// Chooses candidates and their mirror images: each next one is the farthest from all before it and
/// from the clamp, relative to the wanted distance there.
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

/// A point of the surface, and the ports that a contact there would use.
struct Sight {
  Port point;
  double reach = 0.0;           // m: one port is to be nearer
  double nearest = kNeverSeen;  // m: the nearest
  std::size_t count = 0;        // of those that are seen at all and not far away
};

/// So few determine all rigid motions of a small face, and how it bends.
constexpr std::size_t kFewestSeen = 7;

/// How urgently a point needs a port; not at all if it is not above 0.
double lack_of(const Sight& sight, double spacing) {
  if (sight.count == 0) {
    return kNeverSeen;
  }
  // Of the spacing. At this distance the end of a rod 1 : 100 has room for kFewestSeen ports.
  constexpr double kTooNear = 0.2;
  const bool few = sight.count < kFewestSeen && sight.nearest > kTooNear * spacing;
  return few || sight.nearest > sight.reach ? sight.nearest : 0.0;
}

/// Adds ports to faces that have too few of their own, such as the end of a rod or the narrow rim
/// of a tube: always at the point whose nearest port is the farthest.
/// @param most  how many
void add_seen_ports(std::vector<Sight> sights, double spacing, std::size_t most,
                    std::vector<Port>& ports) {
  constexpr double kNotFar = 3.0;  // spacings
  const auto see = [&](const Port& port) {
    for (Sight& sight : sights) {
      const double seen =
          seen_distance({port.position, port.normal}, sight.point.position, sight.point.normal);
      sight.nearest = std::min(sight.nearest, seen);
      const double away = glm::distance(port.position, sight.point.position);
      sight.count += seen < kNeverSeen && away < kNotFar * spacing ? 1U : 0U;
    }
  };
  std::ranges::for_each(ports, see);
  const auto lack = [&](const Sight& sight) {
    return lack_of(sight, spacing);
  };
  for (std::size_t added = 0; added < most && !sights.empty(); ++added) {
    const auto farthest = std::ranges::max_element(sights, {}, lack);
    if (lack(*farthest) <= 0.0) {
      break;
    }
    const Port chosen = farthest->point;
    ports.push_back(chosen);
    see(chosen);
  }
}

/// Farther than any point of a face with ports is from the nearest (measured: 2.5 spacings).
constexpr double kWithoutPorts = 3.0;
constexpr double kApartOnWalls = 0.6;  // of a wall's thickness, where contacts are expected

/// Of the points that are near neither an edge nor the clamp.
/// @param walls  where contacts are expected on thin walls; null: nowhere
std::vector<Sight> sights_of(const ElasticSolid& solid, const SurfacePoints& points,
                             const Focus* walls, double wall, double spacing) {
  const double inset = std::min(spacing / 3.0, wall / 8.0);
  const double from_clamp = std::min(spacing, wall);
  const auto is_near_clamp = [&](const Port& point) {
    return std::ranges::any_of(points.clamped, [&](const glm::dvec3& clamped) {
      return glm::distance(point.position, clamped) < from_clamp;
    });
  };
  std::vector<Sight> sights;
  for (const Port& point : points.free) {
    if (is_smooth(solid, point, inset) && !is_near_clamp(point)) {
      const bool in_walls =
          walls != nullptr && glm::distance(point.position, walls->center) < walls->radius;
      sights.push_back({point, in_walls ? kApartOnWalls * wall : kWithoutPorts * spacing});
    }
  }
  return sights;
}

}  // namespace

std::vector<Port> choose_ports(const ElasticSolid& solid, std::uint32_t count,
                               const ExpectedPlace& expected) {
  const SurfacePoints coarse = sample_solid_surface(solid);
  const double spacing = std::sqrt(coarse.area / std::max(count, 1U));
  const double wall = wall_thickness(solid, coarse);
  const bool on_walls = expected.known && wall < spacing;
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double longest = std::max({extent.x, extent.y, extent.z});
  const SurfacePoints fine =
      sample_solid_surface(solid, std::clamp(4.0 * longest / wall, 28.0, 56.0));
  const SurfacePoints& points = on_walls ? fine : coarse;
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
  add_seen_ports(sights_of(solid, fine, on_walls ? &density.focus : nullptr, wall, spacing),
                 spacing, count, ports);
  return ports;
}

double port_distance_over_thickness(const ElasticSolid& solid, std::span<const Port> ports,
                                    const ExpectedPlace& expected) {
  const std::vector<Port> points = sample_solid_surface(solid).free;
  const std::vector<double> walls = walls_at(solid, points);
  std::vector<double> shares;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Port& point = points[i];
    if (expected.known &&
        glm::distance(point.position, expected.center) > expected.radius + walls[i]) {
      continue;
    }
    double nearest = kNeverSeen;
    for (const Port& port : ports) {
      nearest = std::min(nearest,
                         seen_distance({port.position, port.normal}, point.position, point.normal));
    }
    shares.push_back(nearest / walls[i]);
  }
  if (shares.empty()) {
    return 0.0;
  }
  const auto at =
      shares.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(shares.size()));
  std::nth_element(shares.begin(), at, shares.end());
  return *at;
}

}  // namespace torsion::engine
