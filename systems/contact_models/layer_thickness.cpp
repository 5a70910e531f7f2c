#include "systems/contact_models/layer_thickness.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace torsion {
namespace {

constexpr double kWide = 4.0;  // a body at least so many times as wide as thick is a layer

/// @param thickness  m, along the fixed face's normal
bool is_wide(const World& world, std::uint32_t body, double thickness) {
  const FixedRegion& fixed = world.bodies.at<FixedRegion>(body);
  const Bounds& bounds = world.bodies.at<Bounds>(body);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  const glm::dvec3 across = size - size * glm::abs(fixed.normal);
  const double width = std::min({across.x > 0.1 * thickness ? across.x : 1e300,
                                 across.y > 0.1 * thickness ? across.y : 1e300,
                                 across.z > 0.1 * thickness ? across.z : 1e300});
  return width > kWide * thickness;
}

}  // namespace

bool is_layer(const World& world, std::uint32_t body) {
  const FixedRegion& fixed = world.bodies.at<FixedRegion>(body);
  const Bounds& bounds = world.bodies.at<Bounds>(body);
  const double thickness = glm::dot(bounds.highest - bounds.lowest, glm::abs(fixed.normal));
  return fixed.kind == FixedKind::kFace && is_wide(world, body, thickness);
}

double layer_thickness(const World& world, std::uint32_t body, const glm::dvec3& normal,
                       const glm::dvec3& point) {
  const FixedRegion& fixed = world.bodies.at<FixedRegion>(body);
  if (fixed.kind != FixedKind::kFace || glm::dot(fixed.normal, normal) < 0.9) {
    return 0.0;
  }
  const double thickness = glm::dot(point - fixed.point, fixed.normal);
  return thickness > 0.0 && is_wide(world, body, thickness) ? thickness : 0.0;
}

}  // namespace torsion
