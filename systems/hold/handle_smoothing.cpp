#include "systems/hold/handle_smoothing.hpp"

#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

namespace torsion::engine {
namespace {

void follow(Pose& pose, const Pose& target, double share) {
  pose.position += share * (target.position - pose.position);
  pose.rotation = glm::normalize(glm::slerp(pose.rotation, target.rotation, share));
}

}  // namespace

void restart_smoothing(HandleSmoothing& smoothing, const Pose& at) {
  smoothing.first = at;
  smoothing.second = at;
}

Pose smooth(HandleSmoothing& smoothing, const Pose& sample, double dt) {
  const double share = -std::expm1(-dt / kSmoothingTime);
  follow(smoothing.first, sample, share);
  follow(smoothing.second, smoothing.first, share);
  return smoothing.second;
}

}  // namespace torsion::engine
