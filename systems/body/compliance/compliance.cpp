#include "systems/body/compliance/compliance.hpp"

#include <algorithm>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/body/compliance/newton_step.hpp"
#include "systems/body/compliance/support_motion.hpp"
#include "systems/body/compliance/supported_regions.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

/// The other regions' part of such a region's next motion. It is Newton's change du, less the
/// deflection by the region's own load, du + C K du, of which friction may not hold all, less the
/// others' answer to that load's change (RegionReaction), and less the effect of the own load's
/// place (add_sway).
/// @param scaled  y of NewtonStep
void move_by_others(const CompliantBody& body, std::size_t i, const NewtonStep& newton,
                    const Vector6& scaled) {
  const Vector6 held = scaled - newton.slips[i].slipped;
  const SupportedRegion& supported = body.regions[i];
  const StiffnessRoot& root = newton.roots[i];
  const SupportFit& support_fit = support_fit_of(body, supported);
  RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
  Vector6 by_others = support_by_others(support, support_fit.center) + root.inverse * scaled;
  if (support_fit.on_layer == 0) {
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    by_others += own * (root.root * held);
    if (newton.sways_together) {
      by_others -= own * (wrench_by_place(supported) * (newton.moved[i] + root.inverse * scaled));
    }
  }
  const RegionReaction& reaction = body.state.regions.at<RegionReaction>(supported.region);
  if (reaction.active != 0) {
    by_others -= Eigen::Map<const Matrix6>(reaction.motion.data()) * (root.root * held);
  }
  support.translation_by_others = {by_others[0], by_others[1], by_others[2]};
  support.rotation_by_others = {by_others[3], by_others[4], by_others[5]};
}

void move_supports(const CompliantBody& body, const NewtonStep& newton) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportedRegion& supported = body.regions[i];
    const glm::dvec3& center = support_fit_of(body, supported).center;
    RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
    const Vector6 before = support_at(support, center);
    const Vector6 scaled = newton.motion.segment<6>(static_cast<Eigen::Index>(6 * i));
    // The predicted motion. For contact model patch it extrapolates the change of the region's own
    // load, which its equations then compute. Predicted from the other regions' changes alone,
    // without its own answer, it would lie far from the tool on a body that sways much.
    const Vector6 after = support_now(body, supported) + newton.roots[i].inverse * scaled;
    if (supported.solved) {
      move_by_others(body, i, newton, scaled);
    } else {
      // The predicted load.
      Eigen::Map<Vector6>(body.state.regions.at<RegionReaction>(supported.region).wrench.data()) =
          supported.load.wrench - newton.roots[i].root * (scaled - newton.slips[i].slipped);
    }
    const Vector6 step = after - before + answer_at(support, center);
    support.about = center;
    support.translation = {after[0], after[1], after[2]};
    support.rotation = {after[3], after[4], after[5]};
    support.translation_step = {step[0], step[1], step[2]};
    support.rotation_step = {step[3], step[4], step[5]};
  }
}

/// For a region whose equations include the body's answer to its own load (contact_load.hpp).
void take_own_answer(const SupportAnswer& answer, RegionSupport& support,
                     RegionReaction& reaction) {
  support.translation += answer.translation;
  support.rotation += answer.rotation;
  support.translation_step = answer.translation_left;
  support.rotation_step = answer.rotation_left;
  Eigen::Map<Vector6>(reaction.wrench.data()) += Eigen::Map<const Vector6>(answer.wrench.data());
  reaction.active = 0;
}

/// For a region whose equations include the other regions' answers, which have moved it by now.
void take_answers(StepContext& context, std::uint32_t row) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    RegionReaction& reaction = state.regions.at<RegionReaction>(region);
    RegionSupport& support = state.regions.at<RegionSupport>(region);
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    if (identity.body != row) {
      continue;
    }
    if (law_of(model, row).moves_own_support) {
      take_own_answer(context.scratch.support_answers[block_of(identity)], support, reaction);
      continue;
    }
    support.translation_step = glm::dvec3(0.0);
    support.rotation_step = glm::dvec3(0.0);
    if (reaction.active == 0) {
      continue;
    }
    const SupportFit& support_fit = state.support_fits.at<SupportFit>(block_of(identity));
    const Vector6 more = contact_load(model, state, region, support_fit).wrench -
                         Eigen::Map<const Vector6>(reaction.wrench.data());
    const Vector6 moved = -(Eigen::Map<const Matrix6>(reaction.motion.data()) * more);
    const glm::dvec3 translation(moved[0], moved[1], moved[2]);
    const glm::dvec3 rotation(moved[3], moved[4], moved[5]);
    support.translation_step = translation;
    support.rotation_step = rotation;
    support.translation += translation;
    support.rotation += rotation;
    support.translation_by_others += translation;
    support.rotation_by_others += rotation;
    reaction = RegionReaction{};
  }
}

void deform_body(StepContext& context, std::uint32_t row) {
  take_answers(context, row);
  CompliantBody body{context.model, context.state, row, ports_of(context.model, row)};
  find_supported_regions(body);
  find_couplings(body);
  NewtonStep newton = newton_step(body, context.compliance);
  if (!newton.motion.allFinite()) {
    raise(context.state.clock, Fault::kResultNotFinite);
    newton.motion.setZero();
  }
  move_supports(body, newton);
}

}  // namespace

const BodyLaw kComplianceLaw{
    .model = BodyModel::kCompliance,
    .moves_as_a_whole = true,
    .motion_at = motion_of_material,
    .begin = begin_support,
    .begin_answer = begin_answer,
    .begin_split = begin_split_support,
    .split = split_support,
    .join = join_support,
};

void ComplianceScratch::reserve(const State& state) {
  if (!state.support_fits.empty()) {
    constexpr std::size_t kRows = std::size_t{6} * kMaxRegionsPerBody;
    matrix.resize(kRows * kRows);
    copy.resize(kRows * kRows);
    inverse.resize(kRows * kRows);
    full.resize(kRows * kRows);
  }
}

void compliance(StepContext& context) {
  for (std::uint32_t body = 0; body < context.model.bodies.size(); ++body) {
    if (context.model.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      deform_body(context, body);
    }
  }
}

}  // namespace torsion::engine
