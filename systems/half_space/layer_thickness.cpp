#include "systems/half_space/layer_thickness.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace torsion {
namespace {

constexpr double kWide = 4.0;  // a body at least so many times as wide as thick is a layer

/// @param thickness  m, along the fixed face's normal
bool is_wide(const Model& model, std::uint32_t body, double thickness) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 along = glm::abs(fixed.normal);
  const glm::dvec3 across = (bounds.highest - bounds.lowest) * (1.0 - along);
  // Along two of the axes; the third is nearest to the normal.
  const double steepest = std::max({along.x, along.y, along.z});
  double width = 1e300;
  bool seen = false;
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == steepest && !seen) {
      seen = true;
    } else {
      width = std::min(width, across[axis]);
    }
  }
  return width > kWide * thickness;
}

}  // namespace

bool is_layer(const Model& model, std::uint32_t body) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const double thickness = glm::dot(bounds.highest - bounds.lowest, glm::abs(fixed.normal));
  return fixed.kind == FixedKind::kFace && is_wide(model, body, thickness);
}

double layer_thickness(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                       const glm::dvec3& point) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  if (fixed.kind != FixedKind::kFace || glm::dot(fixed.normal, normal) < 0.9) {
    return 0.0;
  }
  const double thickness = glm::dot(point - fixed.point, fixed.normal);
  return thickness > 0.0 && is_wide(model, body, thickness) ? thickness : 0.0;
}

}  // namespace torsion
