#pragma once

#include <glm/gtc/quaternion.hpp>

#include "ecs/model.hpp"
#include "ecs/state.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {

/// A region seen from the world. Its contact was found in the axes of the material under it, which
/// has moved with the body.
class WorldRegion {
 public:
  /// @param support  how the body as a whole has moved the material
  WorldRegion(const State& state, std::uint32_t region, const RegionSupport& support)
      : body_(state.bodies.at<BodyPose>(state.regions.at<RegionIdentity>(region).body).now),
        support_(support) {
    const double turn = glm::length(support.rotation);
    turned_ = turn > 0.0;
    if (turned_) {
      rotation_ = glm::angleAxis(turn, support.rotation / turn);
    }
  }

  /// The world's of a direction in the region's axes, body.
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& in_body) const {
    return body_.rotation * (turned_ ? rotation_ * in_body : in_body);
  }

  /// The world's of a point of the region, m, body.
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& point) const {
    return to_outer(body_,
                    (turned_ ? support_.about + rotation_ * (point - support_.about) : point) +
                        support_.translation);
  }

 private:
  Pose body_;
  RegionSupport support_;
  glm::dquat rotation_{1.0, 0.0, 0.0, 0.0};
  bool turned_ = false;
};

}  // namespace torsion::engine
