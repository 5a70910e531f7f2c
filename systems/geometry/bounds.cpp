#include "systems/geometry/bounds.hpp"

#include <glm/common.hpp>

namespace torsion::engine {
namespace {

constexpr Bounds kOfNothing{glm::dvec3(1e300), glm::dvec3(-1e300)};

void include(Bounds& bounds, std::span<const glm::dvec3> places) {
  for (const glm::dvec3& place : places) {
    bounds.lowest = glm::min(bounds.lowest, place);
    bounds.highest = glm::max(bounds.highest, place);
  }
}

}  // namespace

Bounds bounds_of(std::span<const glm::dvec3> places) {
  Bounds bounds = kOfNothing;
  include(bounds, places);
  return bounds;
}

Bounds bounds_of(std::span<const PartDescription> parts) {
  Bounds bounds = kOfNothing;
  for (const PartDescription& part : parts) {
    include(bounds, part.surface.positions);
  }
  return bounds;
}

bool boxes_meet(const Bounds& a, const Bounds& b, double slack) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lowest[axis] > b.highest[axis] + slack || b.lowest[axis] > a.highest[axis] + slack) {
      return false;
    }
  }
  return true;
}

}  // namespace torsion::engine
