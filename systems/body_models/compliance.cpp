#include "systems/body_models/compliance.hpp"

#include <algorithm>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/body_models/region_stands.hpp"
#include "systems/body_models/symmetric_solve.hpp"
#include "systems/fault.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// No compliance of a body takes more than this of the contacts' own away (region_stands.cpp); what
/// footings of other steps make of it must not either.
constexpr double kLeastPivot = 0.25;

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// The material's motion at `point` as the region's support has it.
Vector6 support_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation + glm::cross(support.rotation, point - support.about)),
      eigen(support.rotation);
  return motion;
}

/// The part of it that other regions have to do with.
Vector6 support_by_others(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation_by_others +
                  glm::cross(support.rotation_by_others, point - support.about)),
      eigen(support.rotation_by_others);
  return motion;
}

/// The motion that Newton's step starts from. A region with contact model patch, which knows in its
/// own equations what its load does (patch_support.hpp), stands where that has moved it.
Vector6 support_now(const CompliantBody& body, const Stand& stand) {
  const RegionSupport& support = body.world.regions.at<RegionSupport>(stand.region);
  const glm::dvec3& center = footing_of(body, stand).center;
  return stand.solved ? Vector6(stand.motion + support_by_others(support, center))
                      : support_at(support, center);
}

/// Of such a region Newton's change is that by the others less what its own load gives way by it:
/// the former is its own part of the equations, (I + C K) du.
/// @param scaled  y of fill_equations
/// @return where its support is to be
Vector6 move_by_others(const CompliantBody& body, const Stand& stand, const StiffnessRoot& root,
                       const Vector6& scaled) {
  const Footing& footing = footing_of(body, stand);
  RegionSupport& support = body.world.regions.at<RegionSupport>(stand.region);
  Vector6 by_others = support_by_others(support, footing.center) + root.inverse * scaled;
  if (footing.on_layer == 0) {
    by_others += Eigen::Map<const Matrix6>(footing.own.data()) * (root.root * scaled);
  }
  support.translation_by_others = {by_others[0], by_others[1], by_others[2]};
  support.rotation_by_others = {by_others[3], by_others[4], by_others[5]};
  return stand.motion + by_others;
}

void move_supports(const CompliantBody& body, const Eigen::Map<Eigen::VectorXd>& change,
                   const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const Stand& stand = body.stands[i];
    const glm::dvec3& center = footing_of(body, stand).center;
    RegionSupport& support = body.world.regions.at<RegionSupport>(stand.region);
    const Vector6 before = support_at(support, center);
    const Vector6 scaled = change.segment<6>(static_cast<Eigen::Index>(6 * i));
    const Vector6 after = stand.solved ? move_by_others(body, stand, roots[i], scaled)
                                       : Vector6(before + roots[i].inverse * scaled);
    const Vector6 step = after - before;
    support.about = center;
    support.translation = {after[0], after[1], after[2]};
    support.rotation = {after[3], after[4], after[5]};
    support.translation_step = {step[0], step[1], step[2]};
    support.rotation_step = {step[3], step[4], step[5]};
  }
}

/// Newton's matrix and how far each region is from where all loads move it, du: with y = K^(1/2) du
/// the equations (I + C K) du = r are (I + K^(1/2) C K^(1/2)) y = K^(1/2) r, symmetric. Fills the
/// blocks on the diagonal and right of it.
void fill_equations(const CompliantBody& body,
                    const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots,
                    Eigen::Map<RowMatrix>& matrix, Eigen::Map<Eigen::VectorXd>& change) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const Stand& stand = body.stands[i];
    const Footing& footing = footing_of(body, stand);
    const auto at = static_cast<Eigen::Index>(6 * i);
    auto own = matrix.block<6, 6>(at, at);
    own.setIdentity();
    if (footing.on_layer == 0) {
      own += roots[i].root * Eigen::Map<const Matrix6>(footing.own.data()) * roots[i].root;
    }
    change.segment<6>(at) += stand.motion - support_now(body, stand);
    for (std::size_t j = i + 1; j < body.count; ++j) {
      const Stand& other = body.stands[j];
      const Eigen::Map<const Matrix6> stored(coupling_between(body, stand, other).motion.data());
      const Matrix6 motion = stand.block > other.block ? Matrix6(stored) : stored.transpose();
      const auto there = static_cast<Eigen::Index>(6 * j);
      matrix.block<6, 6>(at, there).noalias() = roots[i].root * (motion * roots[j].root);
      change.segment<6>(at) += motion * other.load.wrench;
      change.segment<6>(there) += motion.transpose() * stand.load.wrench;
    }
  }
  for (std::size_t i = 0; i < body.count; ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    change.segment<6>(at) = (roots[i].root * change.segment<6>(at)).eval();
  }
}

void deform_body(StepContext& context, std::uint32_t row) {
  CompliantBody body{context.world, row, ports_of(context.world, row)};
  find_stands(body);
  find_couplings(body);
  std::array<StiffnessRoot, kMaxRegionsPerBody> roots;
  for (std::size_t i = 0; i < body.count; ++i) {
    roots[i] = stiffness_root(body, body.stands[i]);
  }
  const std::size_t size = 6 * body.count;
  const auto rows = static_cast<Eigen::Index>(size);
  Eigen::Map<RowMatrix> matrix(context.scratch.compliance_matrix.data(), rows, rows);
  Eigen::Map<Eigen::VectorXd> change(context.scratch.compliance_residuals.data(), rows);
  change.setZero();
  fill_equations(body, roots, matrix, change);
  solve_symmetric(size, size, matrix.data(), 1, change.data(), kLeastPivot);
  if (!change.allFinite()) {
    raise(context.world.clock.at<Clock>(0), Fault::kResultNotFinite);
    change.setZero();
  }
  move_supports(body, change, roots);
}

}  // namespace

void compliance(StepContext& context) {
  for (std::uint32_t body = 0; body < context.world.bodies.size(); ++body) {
    if (context.world.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      deform_body(context, body);
    }
  }
}

}  // namespace torsion
