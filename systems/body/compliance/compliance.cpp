#include "systems/body/compliance/compliance.hpp"

#include <algorithm>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/body/compliance/region_stands.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
// Within the step, which takes nothing from the heap.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6 * kMaxRegionsPerBody, 1>;

/// No compliance of a body takes more than this of the contacts' own away (region_stands.cpp); what
/// support fits of other steps make of it must not either.
constexpr double kLeastPivot = 0.25;

/// The material's motion at `point` as the region's support has it.
Vector6 support_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation + glm::cross(support.rotation, point - support.about)),
      eigen(support.rotation);
  return motion;
}

/// The part of its last step that is the others' answer (take_answers).
Vector6 answer_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation_step +
                  glm::cross(support.rotation_step, point - support.about)),
      eigen(support.rotation_step);
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

/// The rest, by its own load.
Vector6 own_support(const CompliantBody& body, const Stand& stand) {
  const RegionSupport& support = body.state.regions.at<RegionSupport>(stand.region);
  const glm::dvec3& center = support_fit_of(body, stand).center;
  return support_at(support, center) - support_by_others(support, center);
}

/// The motion that Newton's step starts from. A region with contact model patch, which knows in its
/// own equations what its load does (patch/support.hpp), stands where that has moved it.
Vector6 support_now(const CompliantBody& body, const Stand& stand) {
  const RegionSupport& support = body.state.regions.at<RegionSupport>(stand.region);
  const glm::dvec3& center = support_fit_of(body, stand).center;
  return stand.solved ? Vector6(stand.motion + support_by_others(support, center))
                      : support_at(support, center);
}

/// How a load's wrench about its support fit's centre changes by a translation of the material
/// under it: the tool stands elsewhere on it, so that the load has the couple force x translation
/// more. Nothing for a contact model that does not say where on the material its load lies.
Matrix6 wrench_by_place(const Stand& stand) {
  Matrix6 wrench = Matrix6::Zero();
  if (stand.solved) {
    const Eigen::Vector3d force = stand.load.wrench.head<3>();
    wrench.bottomLeftCorner<3, 3>() << 0.0, -force.z(), force.y(), force.z(), 0.0, -force.x(),
        -force.y(), force.x(), 0.0;
  }
  return wrench;
}

/// Newton's step of one body.
struct NewtonStep {
  std::array<StiffnessRoot, kMaxRegionsPerBody> roots;
  // Whether the regions' loads go with what moves them, all regions' together (add_sway), and by
  // how much each region has been moved since its load was found.
  bool sways_together = false;
  std::array<Vector6, kMaxRegionsPerBody> moved;
};

/// What the other regions are to have to do with such a region's motion: Newton's change du is that
/// by them less what its own load deflects by it, (I + C K) du, less what the others' answer to
/// its own change will be (RegionReaction), and less what its own load's place does (add_sway).
/// @param scaled  y of fill_equations
void move_by_others(const CompliantBody& body, std::size_t i, const NewtonStep& newton,
                    const Vector6& scaled) {
  const Stand& stand = body.stands[i];
  const StiffnessRoot& root = newton.roots[i];
  const SupportFit& support_fit = support_fit_of(body, stand);
  RegionSupport& support = body.state.regions.at<RegionSupport>(stand.region);
  Vector6 by_others = support_by_others(support, support_fit.center) + root.inverse * scaled;
  if (support_fit.on_layer == 0) {
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    by_others += own * (root.root * scaled);
    if (newton.sways_together) {
      by_others -= own * (wrench_by_place(stand) * (newton.moved[i] + root.inverse * scaled));
    }
  }
  const RegionReaction& reaction = body.state.regions.at<RegionReaction>(stand.region);
  if (reaction.active != 0) {
    by_others -= Eigen::Map<const Matrix6>(reaction.motion.data()) * (root.root * scaled);
  }
  support.translation_by_others = {by_others[0], by_others[1], by_others[2]};
  support.rotation_by_others = {by_others[3], by_others[4], by_others[5]};
}

/// How a wrench on one region moves it or another one, as Newton's matrix has it.
Matrix6 compliance_between(const CompliantBody& body, const Stand& to, const Stand& from) {
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
    const Stand& stand = body.stands[i];
    const glm::dvec3& center = support_fit_of(body, stand).center;
    RegionSupport& support = body.state.regions.at<RegionSupport>(stand.region);
    const Vector6 before = support_at(support, center);
    const Vector6 scaled = change.segment<6>(static_cast<Eigen::Index>(6 * i));
    // Where it is to be seen next. For contact model patch that extrapolates how its own load
    // changes, which its equations then find: seen from where all of the others' change but nothing
    // of its own answer has moved it, it would lie far from the tool on a body that sways much.
    const Vector6 after = support_now(body, stand) + newton.roots[i].inverse * scaled;
    if (stand.solved) {
      move_by_others(body, i, newton, scaled);
    } else {
      // The load that it is to have there.
      Eigen::Map<Vector6>(body.state.regions.at<RegionReaction>(stand.region).wrench.data()) =
          stand.load.wrench - newton.roots[i].root * scaled;
    }
    const Vector6 step = after - before + answer_at(support, center);
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
    const SupportFit& support_fit = support_fit_of(body, stand);
    const auto at = static_cast<Eigen::Index>(6 * i);
    auto own = matrix.block<6, 6>(at, at);
    own.setIdentity();
    if (support_fit.on_layer == 0) {
      own += roots[i].root * Eigen::Map<const Matrix6>(support_fit.own.data()) * roots[i].root;
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

/// Of a region with contact model patch: where it is to be seen next by its own load. A body that
/// sways much by couples would go to and fro, for what its sway does to them shows only in the next
/// step. By one Newton step, with w the load and C the compliance: u + du = C w(u + du), where the
/// wrench is w's own and G du more (wrench_by_place). Never farther than C w itself.
void sway(const CompliantBody& body, Stand& stand) {
  const SupportFit& support_fit = support_fit_of(body, stand);
  if (!stand.solved || support_fit.on_layer != 0) {
    return;
  }
  const Vector6 now = own_support(body, stand);
  const Vector6 plain = stand.motion - now;
  const Eigen::Map<const Matrix6> own(support_fit.own.data());
  const Matrix6 newton = Matrix6::Identity() - own * wrench_by_place(stand);
  const Vector6 step = solve_lu(newton, plain);
  if (step.allFinite() && step.head<3>().norm() <= plain.head<3>().norm()) {
    stand.motion = now + step;
  }
}

/// Whether the body deflects under two regions at least by so much, beside the contacts, that the
/// one feels within a step how the other answers.
bool answers_within_a_step(const CompliantBody& body, const ContactLaw& law,
                           const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots) {
  std::size_t soft = 0;
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportFit& support_fit = support_fit_of(body, body.stands[i]);
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    const double share = (roots[i].root * own * roots[i].root).trace();
    soft += support_fit.on_layer == 0 && share > law.answers_from ? 1U : 0U;
  }
  return soft >= 2;
}

/// Solves with Newton's symmetric matrix. Couplings between regions that lie in each other's reach
/// are found through support fits of different steps and sizes, and may come to more than what they
/// couple; the matrix then has no solution that means anything, of whatever size. It is solved with
/// half of them, a quarter, none: the blocks on the diagonal are definite on their own.
/// @param matrix  its part right of the diagonal; couplings become what they are solved with
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

/// What each region feels of its own load when the others have answered is the Schur complement of
/// its block in Newton's matrix, the inverse of that block of the inverse: K^-1 + C_ii - D with D
/// the answer. (Golub and Van Loan, Matrix Computations, 3.2.11)
/// @param matrix  of fill_equations, which it makes definite
/// @param copy    is overwritten
void find_reactions(const CompliantBody& body,
                    const std::array<StiffnessRoot, kMaxRegionsPerBody>& roots,
                    Eigen::Map<RowMatrix>& matrix, Eigen::Map<RowMatrix>& copy,
                    Eigen::Map<RowMatrix>& inverse) {
  solve_newton(
      matrix, copy, [&inverse] { inverse.setIdentity(); }, inverse);
  for (std::size_t i = 0; i < body.count; ++i) {
    const Stand& stand = body.stands[i];
    const SupportFit& support_fit = support_fit_of(body, stand);
    RegionReaction& reaction = body.state.regions.at<RegionReaction>(stand.region);
    if (support_fit.on_layer != 0) {
      continue;
    }
    const auto at = static_cast<Eigen::Index>(6 * i);
    const Matrix6 block = inverse.block<6, 6>(at, at);
    Matrix6 answered = Matrix6::Zero();  // S - I, S the Schur complement
    const EigenSystem6 system = eigen_system(0.5 * (block + block.transpose()));
    // The others take away at most what there is.
    const Vector6 left =
        (system.values.cwiseMax(1e-12).cwiseInverse().array() - 1.0).cwiseMax(0.0).matrix();
    answered = system.vectors * left.asDiagonal() * system.vectors.transpose();
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    const Matrix6 motion = own - roots[i].inverse * answered * roots[i].inverse;
    if (motion.allFinite()) {
      Eigen::Map<Matrix6>(reaction.motion.data()) = 0.5 * (motion + motion.transpose());
      Eigen::Map<Vector6>(reaction.wrench.data()) = stand.load.wrench;
      reaction.active = 1;
    }
  }
}

/// sway() of all regions of a body together, for what moves the one moves the other as well: two
/// tools that pinch a body sway it by their couples each, which cancel. With v what Newton's step
/// finds and s what its regions have been moved by already since their loads were found, their
/// answers included: (I + C K - C G) v = r + C G s.
/// @param upper   of fill_equations
/// @param full    n x n, is filled with Newton's matrix, not symmetric
/// @param change  of fill_equations; K^(1/2) C G s is added
void add_sway(const CompliantBody& body, const Eigen::Map<RowMatrix>& upper, NewtonStep& newton,
              Eigen::Map<RowMatrix>& full, Eigen::Map<Eigen::VectorXd>& change) {
  newton.sways_together = true;
  full = upper.selfadjointView<Eigen::Upper>();
  for (std::size_t j = 0; j < body.count; ++j) {
    const Stand& from = body.stands[j];
    const RegionSupport& support = body.state.regions.at<RegionSupport>(from.region);
    newton.moved[j] = from.motion - own_support(body, from) +
                      answer_at(support, support_fit_of(body, from).center);
    const Matrix6 by_place = wrench_by_place(from);
    const auto there = static_cast<Eigen::Index>(6 * j);
    for (std::size_t i = 0; i < body.count; ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      const Matrix6 sways =
          newton.roots[i].root * compliance_between(body, body.stands[i], from) * by_place;
      full.block<6, 6>(at, there) -= sways * newton.roots[j].inverse;
      change.segment<6>(at) += sways * newton.moved[j];
    }
  }
}

/// Where a region's equations have accounted for the body's answer to its own load
/// (contact_load.hpp).
void take_own_answer(const SupportAnswer& answer, RegionSupport& support,
                     RegionReaction& reaction) {
  support.translation += answer.translation;
  support.rotation += answer.rotation;
  support.translation_step = answer.translation_left;
  support.rotation_step = answer.rotation_left;
  Eigen::Map<Vector6>(reaction.wrench.data()) += Eigen::Map<const Vector6>(answer.wrench.data());
  reaction.active = 0;
}

/// Where a region's equations have accounted for the others' answer, that has moved it by now.
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
  find_stands(body);
  find_couplings(body);
  NewtonStep newton;
  for (std::size_t i = 0; i < body.count; ++i) {
    newton.roots[i] = stiffness_root(body, body.stands[i]);
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
      sway(body, body.stands[i]);
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
    .begin = begin_support,
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

}  // namespace torsion
