#include "systems/body/compliance/compliance.hpp"

#include <algorithm>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/body/compliance/supported_regions.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
// On the stack: a step takes nothing from the heap.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6 * kMaxRegionsPerBody, 1>;

/// The other regions' answers take at most three quarters of a region's own compliance away
/// (supported_regions.cpp); interpolation by support fits of different steps must not exceed that
/// either.
constexpr double kLeastPivot = 0.25;

/// The material's motion at `point` by the region's support.
Vector6 support_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation + glm::cross(support.rotation, point - support.about)),
      eigen(support.rotation);
  return motion;
}

/// The part of its last step that comes from the other regions' answers (take_answers).
Vector6 answer_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation_step +
                  glm::cross(support.rotation_step, point - support.about)),
      eigen(support.rotation_step);
  return motion;
}

/// The part of it that depends on other regions.
Vector6 support_by_others(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation_by_others +
                  glm::cross(support.rotation_by_others, point - support.about)),
      eigen(support.rotation_by_others);
  return motion;
}

/// The remaining part, by the region's own load.
Vector6 own_support(const CompliantBody& body, const SupportedRegion& supported) {
  const RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
  const glm::dvec3& center = support_fit_of(body, supported).center;
  return support_at(support, center) - support_by_others(support, center);
}

/// The motion that Newton's step starts from. A region with contact model patch computes the
/// displacement by its load in its own equations (patch/support.hpp), so it starts from there.
Vector6 support_now(const CompliantBody& body, const SupportedRegion& supported) {
  const RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
  const glm::dvec3& center = support_fit_of(body, supported).center;
  return supported.solved ? Vector6(supported.motion + support_by_others(support, center))
                          : support_at(support, center);
}

/// How a load's wrench about its support fit's centre changes when the material under it is
/// translated: the load then acts at another place of the material, which adds the couple force x
/// translation. Zero for a contact model that does not say where on the material its load acts.
Matrix6 wrench_by_place(const SupportedRegion& supported) {
  Matrix6 wrench = Matrix6::Zero();
  if (supported.solved) {
    const Eigen::Vector3d force = supported.load.wrench.head<3>();
    wrench.bottomLeftCorner<3, 3>() << 0.0, -force.z(), force.y(), force.z(), 0.0, -force.x(),
        -force.y(), force.x(), 0.0;
  }
  return wrench;
}

/// Newton's step of one body.
struct NewtonStep {
  std::array<StiffnessRoot, kMaxRegionsPerBody> roots;
  // Whether the regions' loads move with the material, in one equation for all regions (add_sway);
  // and how far each region has been moved since its load was found.
  bool sways_together = false;
  std::array<Vector6, kMaxRegionsPerBody> moved;
};

/// The other regions' part of such a region's next motion. It is Newton's change du, less the
/// deflection by the region's own load, (I + C K) du, less the others' answer to that load's change
/// (RegionReaction), and less the effect of the own load's place (add_sway).
/// @param scaled  y of fill_equations
void move_by_others(const CompliantBody& body, std::size_t i, const NewtonStep& newton,
                    const Vector6& scaled) {
  const SupportedRegion& supported = body.regions[i];
  const StiffnessRoot& root = newton.roots[i];
  const SupportFit& support_fit = support_fit_of(body, supported);
  RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
  Vector6 by_others = support_by_others(support, support_fit.center) + root.inverse * scaled;
  if (support_fit.on_layer == 0) {
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    by_others += own * (root.root * scaled);
    if (newton.sways_together) {
      by_others -= own * (wrench_by_place(supported) * (newton.moved[i] + root.inverse * scaled));
    }
  }
  const RegionReaction& reaction = body.state.regions.at<RegionReaction>(supported.region);
  if (reaction.active != 0) {
    by_others -= Eigen::Map<const Matrix6>(reaction.motion.data()) * (root.root * scaled);
  }
  support.translation_by_others = {by_others[0], by_others[1], by_others[2]};
  support.rotation_by_others = {by_others[3], by_others[4], by_others[5]};
}

/// Motion of one region by a wrench on it or on another one, as in Newton's matrix.
Matrix6 compliance_between(const CompliantBody& body, const SupportedRegion& to,
                           const SupportedRegion& from) {
  if (to.region == from.region) {
    const SupportFit& support_fit = support_fit_of(body, to);
    return support_fit.on_layer == 0 ? Matrix6(Eigen::Map<const Matrix6>(support_fit.own.data()))
                                     : Matrix6(Matrix6::Zero());
  }
  const Eigen::Map<const Matrix6> stored(coupling_between(body, to, from).motion.data());
  return to.block > from.block ? Matrix6(stored) : Matrix6(stored.transpose());
}

void move_supports(const CompliantBody& body, const Eigen::Map<Eigen::VectorXd>& change,
                   const NewtonStep& newton) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportedRegion& supported = body.regions[i];
    const glm::dvec3& center = support_fit_of(body, supported).center;
    RegionSupport& support = body.state.regions.at<RegionSupport>(supported.region);
    const Vector6 before = support_at(support, center);
    const Vector6 scaled = change.segment<6>(static_cast<Eigen::Index>(6 * i));
    // The predicted motion. For contact model patch it extrapolates the change of the region's own
    // load, which its equations then compute. Predicted from the other regions' changes alone,
    // without its own answer, it would lie far from the tool on a body that sways much.
    const Vector6 after = support_now(body, supported) + newton.roots[i].inverse * scaled;
    if (supported.solved) {
      move_by_others(body, i, newton, scaled);
    } else {
      // The predicted load.
      Eigen::Map<Vector6>(body.state.regions.at<RegionReaction>(supported.region).wrench.data()) =
          supported.load.wrench - newton.roots[i].root * scaled;
    }
    const Vector6 step = after - before + answer_at(support, center);
    support.about = center;
    support.translation = {after[0], after[1], after[2]};
    support.rotation = {after[3], after[4], after[5]};
    support.translation_step = {step[0], step[1], step[2]};
    support.rotation_step = {step[3], step[4], step[5]};
  }
}

/// Newton's matrix, and each region's distance du from where all loads move it. With y = K^(1/2) du
/// the equations (I + C K) du = r are (I + K^(1/2) C K^(1/2)) y = K^(1/2) r, symmetric. Fills the
/// blocks on the diagonal and right of it.
void fill_equations(const CompliantBody& body,
                    const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots,
                    Eigen::Map<RowMatrix>& matrix, Eigen::Map<Eigen::VectorXd>& change) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportedRegion& supported = body.regions[i];
    const SupportFit& support_fit = support_fit_of(body, supported);
    const auto at = static_cast<Eigen::Index>(6 * i);
    auto own = matrix.block<6, 6>(at, at);
    own.setIdentity();
    if (support_fit.on_layer == 0) {
      own += roots[i].root * Eigen::Map<const Matrix6>(support_fit.own.data()) * roots[i].root;
    }
    change.segment<6>(at) += supported.motion - support_now(body, supported);
    for (std::size_t j = i + 1; j < body.count; ++j) {
      const SupportedRegion& other = body.regions[j];
      const Eigen::Map<const Matrix6> stored(
          coupling_between(body, supported, other).motion.data());
      const Matrix6 motion = supported.block > other.block ? Matrix6(stored) : stored.transpose();
      const auto there = static_cast<Eigen::Index>(6 * j);
      matrix.block<6, 6>(at, there).noalias() = roots[i].root * (motion * roots[j].root);
      change.segment<6>(at) += motion * other.load.wrench;
      change.segment<6>(there) += motion.transpose() * supported.load.wrench;
    }
  }
  for (std::size_t i = 0; i < body.count; ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    change.segment<6>(at) = (roots[i].root * change.segment<6>(at)).eval();
  }
}

/// Predicts the motion of a region with contact model patch by its own load. A body that couples
/// make sway much would oscillate, because the effect of the sway on the couples shows only in the
/// next step. One Newton step, with w the load and C the compliance: u + du = C w(u + du), where
/// the wrench w changes by G du (wrench_by_place). Never farther than C w itself.
void sway(const CompliantBody& body, SupportedRegion& supported) {
  const SupportFit& support_fit = support_fit_of(body, supported);
  if (!supported.solved || support_fit.on_layer != 0) {
    return;
  }
  const Vector6 now = own_support(body, supported);
  const Vector6 plain = supported.motion - now;
  const Eigen::Map<const Matrix6> own(support_fit.own.data());
  const Matrix6 newton = Matrix6::Identity() - own * wrench_by_place(supported);
  const Vector6 step = solve_lu(newton, plain);
  if (step.allFinite() && step.head<3>().norm() <= plain.head<3>().norm()) {
    supported.motion = now + step;
  }
}

/// Whether the body deflects so much beside the contacts, under at least two regions, that one of
/// them feels within a step how the other answers.
bool answers_within_a_step(const CompliantBody& body, const ContactLaw& law,
                           const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots) {
  std::size_t soft = 0;
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportFit& support_fit = support_fit_of(body, body.regions[i]);
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    const double share = (roots[i].root * own * roots[i].root).trace();
    soft += support_fit.on_layer == 0 && share > law.answers_from ? 1U : 0U;
  }
  return soft >= 2;
}

/// Solves with Newton's symmetric matrix. Couplings between regions that overlap are found through
/// support fits of different steps and sizes, and may be larger than the compliances that they
/// couple; the matrix is then indefinite and its solution arbitrarily large. Couplings are then
/// halved, quartered, or left out: the blocks on the diagonal are definite.
/// @param matrix  its part right of the diagonal; couplings are replaced by those used
/// @param copy    is overwritten
/// @param begin   sets `right` to the right sides, again for each try
template <class Begin, class Right>
void solve_newton(Eigen::Map<RowMatrix>& matrix, Eigen::Map<RowMatrix>& copy, const Begin& begin,
                  Right& right) {
  constexpr double kDefinite = 0.5 * kLeastPivot;  // but for rounding
  constexpr int kHalvings = 3;  // none are left after the last: each try costs a solution
  const auto size = static_cast<std::size_t>(matrix.rows());
  for (int halvings = 0; halvings <= kHalvings; ++halvings) {
    copy = matrix;
    begin();
    const auto width = static_cast<std::size_t>(right.cols());
    if (solve_symmetric(size, size, copy.data(), width, right.data(), kLeastPivot) >= kDefinite) {
      return;
    }
    const double kept = halvings + 1 < kHalvings ? 0.5 : 0.0;
    for (Eigen::Index at = 0; at + 6 < matrix.rows(); at += 6) {
      matrix.block(at, at + 6, 6, matrix.cols() - at - 6) *= kept;
    }
  }
}

/// A region's compliance after the others have answered is the Schur complement of its block in
/// Newton's matrix, which is the inverse of that block of the inverse: K^-1 + C_ii - D with D the
/// answer. (Golub and Van Loan, Matrix Computations, 3.2.11)
/// @param matrix  of fill_equations, which it makes definite
/// @param copy    is overwritten
void find_reactions(const CompliantBody& body,
                    const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots,
                    Eigen::Map<RowMatrix>& matrix, Eigen::Map<RowMatrix>& copy,
                    Eigen::Map<RowMatrix>& inverse) {
  solve_newton(
      matrix, copy, [&inverse] { inverse.setIdentity(); }, inverse);
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportedRegion& supported = body.regions[i];
    const SupportFit& support_fit = support_fit_of(body, supported);
    RegionReaction& reaction = body.state.regions.at<RegionReaction>(supported.region);
    if (support_fit.on_layer != 0) {
      continue;
    }
    const auto at = static_cast<Eigen::Index>(6 * i);
    const Matrix6 block = inverse.block<6, 6>(at, at);
    Matrix6 answered = Matrix6::Zero();  // S - I, S the Schur complement
    const EigenSystem6 system = eigen_system(0.5 * (block + block.transpose()));
    // The others take away at most the whole compliance.
    const Vector6 left =
        (system.values.cwiseMax(1e-12).cwiseInverse().array() - 1.0).cwiseMax(0.0).matrix();
    answered = system.vectors * left.asDiagonal() * system.vectors.transpose();
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    const Matrix6 motion = own - roots[i].inverse * answered * roots[i].inverse;
    if (motion.allFinite()) {
      Eigen::Map<Matrix6>(reaction.motion.data()) = 0.5 * (motion + motion.transpose());
      Eigen::Map<Vector6>(reaction.wrench.data()) = supported.load.wrench;
      reaction.active = 1;
    }
  }
}

/// sway() for all regions of a body together, because their motions are coupled: the couples of two
/// tools that pinch a body cancel. With v the result of Newton's step and s how far its regions
/// have been moved since their loads were found, including their answers: (I + C K - C G) v = r + C
/// G s.
/// @param upper   of fill_equations
/// @param full    n x n, is filled with Newton's matrix, not symmetric
/// @param change  of fill_equations; K^(1/2) C G s is added
void add_sway(const CompliantBody& body, const Eigen::Map<RowMatrix>& upper, NewtonStep& newton,
              Eigen::Map<RowMatrix>& full, Eigen::Map<Eigen::VectorXd>& change) {
  newton.sways_together = true;
  full = upper.selfadjointView<Eigen::Upper>();
  for (std::size_t j = 0; j < body.count; ++j) {
    const SupportedRegion& from = body.regions[j];
    const RegionSupport& support = body.state.regions.at<RegionSupport>(from.region);
    newton.moved[j] = from.motion - own_support(body, from) +
                      answer_at(support, support_fit_of(body, from).center);
    const Matrix6 by_place = wrench_by_place(from);
    const auto there = static_cast<Eigen::Index>(6 * j);
    for (std::size_t i = 0; i < body.count; ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      const Matrix6 sways =
          newton.roots[i].root * compliance_between(body, body.regions[i], from) * by_place;
      full.block<6, 6>(at, there) -= sways * newton.roots[j].inverse;
      change.segment<6>(at) += sways * newton.moved[j];
    }
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
  NewtonStep newton;
  for (std::size_t i = 0; i < body.count; ++i) {
    newton.roots[i] = stiffness_root(body, body.regions[i]);
  }
  const std::size_t size = 6 * body.count;
  const auto rows = static_cast<Eigen::Index>(size);
  Eigen::Map<RowMatrix> matrix(context.compliance.matrix.data(), rows, rows);
  Eigen::Map<Eigen::VectorXd> change(context.compliance.residuals.data(), rows);
  Eigen::Map<RowMatrix> copy(context.compliance.copy.data(), rows, rows);
  change.setZero();
  const ContactLaw& law = law_of(context.model, row);
  const bool answers = answers_within_a_step(body, law, newton.roots);
  const bool sways_together = answers && law.by_cells;
  if (!sways_together) {
    for (std::size_t i = 0; i < body.count; ++i) {
      sway(body, body.regions[i]);
    }
  }
  fill_equations(body, newton.roots, matrix, change);
  if (answers) {
    Eigen::Map<RowMatrix> inverse(context.compliance.inverse.data(), rows, rows);
    find_reactions(body, newton.roots, matrix, copy, inverse);
  }
  if (sways_together) {
    add_sway(body, matrix, newton, copy, change);
    solve_general(size, copy.data(), change.data());
  } else {
    const Vector residual = change;
    solve_newton(
        matrix, copy, [&] { change = residual; }, change);
  }
  if (!change.allFinite()) {
    raise(context.state.clock, Fault::kResultNotFinite);
    change.setZero();
  }
  move_supports(body, change, newton);
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
    residuals.resize(kRows);
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
