#include "systems/body/compliance/support_motion.hpp"

#include <glm/geometric.hpp>

#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {

Vector6 support_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation + glm::cross(support.rotation, point - support.about)),
      eigen(support.rotation);
  return motion;
}

Vector6 answer_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation_step +
                  glm::cross(support.rotation_step, point - support.about)),
      eigen(support.rotation_step);
  return motion;
}

Vector6 support_by_others(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation_by_others +
                  glm::cross(support.rotation_by_others, point - support.about)),
      eigen(support.rotation_by_others);
  return motion;
}

Vector6 own_support(const CompliantBody& body, const SupportedRegion& supported) {
  const RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
  const glm::dvec3& center = support_fit_of(body, supported).center;
  return support_at(support, center) - support_by_others(support, center);
}

Vector6 support_now(const CompliantBody& body, const SupportedRegion& supported) {
  const RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
  const glm::dvec3& center = support_fit_of(body, supported).center;
  return supported.solved ? Vector6(supported.motion + support_by_others(support, center))
                          : support_at(support, center);
}

Matrix6 wrench_by_place(const SupportedRegion& supported) {
  Matrix6 wrench = Matrix6::Zero();
  if (supported.solved) {
    const Eigen::Vector3d force = supported.load.wrench.head<3>();
    wrench.bottomLeftCorner<3, 3>() << 0.0, -force.z(), force.y(), force.z(), 0.0, -force.x(),
        -force.y(), force.x(), 0.0;
  }
  return wrench;
}

}  // namespace torsion::engine
