#pragma once

#include <glm/gtc/quaternion.hpp>

#include "ecs/model.hpp"
#include "ecs/state.hpp"
#include "systems/math/frames.hpp"

namespace torsion {

/// A region seen from the world: its contact was found in the axes of the material under it, which
/// has moved with the body (systems/contact/region_wrenches.cpp).
class WorldRegion {
 public:
  WorldRegion(const engine::Model& model, const engine::State& state, std::uint32_t region)
      : identity(state.regions.at<engine::RegionIdentity>(region)),
        frame(state.regions.at<engine::RegionFrame>(region)),
        body_(model.bodies.at<engine::Pose>(identity.body)),
        support_(state.regions.at<engine::RegionSupport>(region)) {
    const double turn = glm::length(support_.rotation);
    if (turn > 0.0) {
      rotation_ = glm::angleAxis(turn, support_.rotation / turn);
    }
  }

  const engine::RegionIdentity& identity;
  const engine::RegionFrame& frame;

  /// m, body to world
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& point) const {
    return engine::to_outer(
        body_, support_.about + rotation_ * (point - support_.about) + support_.translation);
  }
  [[nodiscard]] glm::dvec3 normal() const { return body_.rotation * (rotation_ * frame.normal); }
  /// Of a vector in the grid's plane.
  [[nodiscard]] glm::dvec3 along(const glm::dvec2& in_grid) const {
    return body_.rotation * (rotation_ * engine::tangent_to_body(frame, in_grid));
  }

 private:
  const engine::Pose& body_;
  const engine::RegionSupport& support_;
  glm::dquat rotation_{1.0, 0.0, 0.0, 0.0};
};

}  // namespace torsion
