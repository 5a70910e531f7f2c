#include "systems/contact/support/own_answer.hpp"

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/contact/support/body_law.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {
namespace {

// Of what the loads move, in the step in which they are found. The rest is compliance's, a step
// later, which takes energy; an answer that went too far, of a footing that no longer quite fits,
// would be taken back, which feeds some.
constexpr double kFirst = 0.9;

using LoadColumns = Eigen::Matrix<double, 6, 4>;  // wrenches by loads

/// The footing whose compliance the region's support comes from, or null.
const Footing* footing_under(const Model& model, const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  if (!body_law_of(model, identity.body).moves_as_a_whole) {
    return nullptr;
  }
  const Footing& footing = state.footings.at<Footing>(block_of(identity));
  return footing.reach > 0.0 && footing.on_layer == 0 ? &footing : nullptr;
}

/// Each load of 1 as a wrench about the footing's centre.
LoadColumns unit_loads(const RegionFrame& frame, const Footing& footing, const glm::dvec3& point) {
  const glm::dvec3 arm = point - footing.center;
  LoadColumns columns = LoadColumns::Zero();
  const auto set_force = [&](Eigen::Index column, const glm::dvec3& force) {
    const glm::dvec3 couple = glm::cross(arm, force);
    columns.col(column) << force.x, force.y, force.z, couple.x, couple.y, couple.z;
  };
  set_force(0, frame.tangent_x);
  set_force(1, frame.tangent_y);
  columns.col(2) << 0.0, 0.0, 0.0, frame.normal.x, frame.normal.y, frame.normal.z;
  set_force(3, -frame.normal);
  return columns;
}

/// What the region's own loads move it by: less what the others' answers take back.
Matrix6 yielding(const State& state, std::uint32_t region, const Footing& footing) {
  const RegionReaction& reaction = state.regions.at<RegionReaction>(region);
  Matrix6 motion = Eigen::Map<const Matrix6>(footing.own.data());
  if (reaction.active != 0) {
    motion -= Eigen::Map<const Matrix6>(reaction.motion.data());
  }
  return kFirst * motion;
}

}  // namespace

OwnAnswer own_answer(const Model& model, const State& state, std::uint32_t region,
                     const glm::dvec3& point) {
  OwnAnswer answer;
  const Footing* const footing = footing_under(model, state, region);
  if (footing == nullptr) {
    return answer;
  }
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  answer.wrenches = unit_loads(frame, *footing, point);
  answer.motions.noalias() = yielding(state, region, *footing) * answer.wrenches;
  const Eigen::Matrix4d compliance = answer.wrenches.transpose() * answer.motions;
  const auto& wrench = state.regions.at<RegionReaction>(region).wrench;
  const glm::dvec3 force(wrench[0], wrench[1], wrench[2]);
  const glm::dvec3 couple(wrench[3], wrench[4], wrench[5]);
  answer.any = true;
  answer.point = point;
  answer.known = {glm::dot(force, frame.tangent_x), glm::dot(force, frame.tangent_y),
                  glm::dot(couple - glm::cross(point - footing->center, force), frame.normal),
                  -glm::dot(force, frame.normal)};
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      answer.compliance[column][row] = compliance(row, column);
    }
  }
  return answer;
}

SupportAnswer support_answer(const Model& model, const State& state, std::uint32_t region,
                             const OwnAnswer& answer, const ContactLoads& more,
                             const ContactLoads& reckoned) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const Footing& footing = *footing_under(model, state, region);
  const glm::dvec3& about = state.regions.at<RegionSupport>(region).about;
  const Eigen::Vector4d loads(more.x, more.y, more.z, more.w);
  const Vector6 motion = answer.motions * loads;
  SupportAnswer found;
  found.rotation = {motion[3], motion[4], motion[5]};
  found.translation = glm::dvec3(motion[0], motion[1], motion[2]) +
                      glm::cross(found.rotation, about - footing.center);
  const ContactLoads left = answer.compliance * more - reckoned;
  found.rotation_left = left.z * frame.normal;
  found.translation_left = left.x * frame.tangent_x + left.y * frame.tangent_y +
                           glm::cross(found.rotation_left, about - answer.point);
  Eigen::Map<Vector6>(found.wrench.data()) = answer.wrenches * loads;
  return found;
}

}  // namespace torsion
