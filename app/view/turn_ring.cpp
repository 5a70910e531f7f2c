#include "app/view/turn_ring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
// Cosine of ray and axis, under which a ring counts as seen from its edge.
constexpr double kFlat = 0.12;

/// The angle at which a ray meets the ring's plane; nothing where it meets it flatly, behind the
/// eye, or so near the middle that a pixel is a large turn.
std::optional<double> angle_in_plane(const TurnRing& ring, const PixelRay& ray) {
  const double steepness = glm::dot(ray.direction, ring.axis);
  if (std::abs(steepness) < kFlat) {
    return std::nullopt;
  }
  const double along = glm::dot(ring.center - ray.origin, ring.axis) / steepness;
  const glm::dvec3 met = ray.origin + along * ray.direction - ring.center;
  constexpr double kMiddle = 0.2;  // of the radius
  if (along <= 0.0 || glm::length(met) < kMiddle * ring.radius) {
    return std::nullopt;
  }
  return std::atan2(glm::dot(met, glm::cross(ring.axis, ring.tangent)),
                    glm::dot(met, ring.tangent));
}

}  // namespace

glm::dvec3 TurnRing::at(double angle) const {
  return center +
         radius * (std::cos(angle) * tangent + std::sin(angle) * glm::cross(axis, tangent));
}

TurnRing ring_around(const Pose& pose, const Bounds& bounds, const glm::dvec3& pivot,
                     const glm::dvec3& axis, const glm::dvec3& tangent) {
  constexpr double kWider = 1.6;
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  std::array<double, 3> sides = {size.x, size.y, size.z};
  std::ranges::sort(sides);
  const glm::dvec3 middle =
      pose.position + pose.rotation * (0.5 * (bounds.lowest + bounds.highest));
  return {pivot + glm::dot(middle - pivot, axis) * axis, axis, tangent, 0.5 * kWider * sides[1]};
}

std::optional<double> angle_on(const TurnRing& ring, const Camera& camera, const glm::dvec2& mouse,
                               const glm::dvec2& picture, double reach) {
  constexpr int kPlaces = 180;
  std::optional<double> best;
  double nearest = 0.0;  // m
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = kTurn * i / kPlaces;
    const glm::dvec3 seen = seen_at(camera, ring.at(angle), picture);
    if (seen.z > camera.near_plane && glm::length(glm::dvec2(seen) - mouse) <= reach &&
        (!best || seen.z < nearest)) {
      best = angle;
      nearest = seen.z;
    }
  }
  return best;
}

double turned_by(const TurnRing& ring, double angle, const Camera& camera, const glm::dvec2& from,
                 const glm::dvec2& to, const glm::dvec2& picture) {
  const auto before = angle_in_plane(ring, ray_through(camera, from, picture));
  const auto after = angle_in_plane(ring, ray_through(camera, to, picture));
  if (before && after) {
    return std::remainder(*after - *before, kTurn);
  }
  // Pixels a radian where the ring was taken; from its end, where that is nothing, those of a ring
  // that is seen whole.
  constexpr double kStep = 0.01;
  const glm::dvec2 way = (glm::dvec2(seen_at(camera, ring.at(angle + kStep), picture)) -
                          glm::dvec2(seen_at(camera, ring.at(angle - kStep), picture))) /
                         (2.0 * kStep);
  const double depth = seen_at(camera, ring.center, picture).z;
  const double whole =
      ring.radius * 0.5 * picture.y / (depth * std::tan(0.5 * camera.vertical_field_of_view));
  const double length = std::fmax(glm::length(way), 0.3 * std::abs(whole));
  return length > 0.0 ? glm::dot(to - from, way) / (length * length) : 0.0;
}

}  // namespace torsion::engine
