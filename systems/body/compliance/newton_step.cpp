#include "systems/body/compliance/newton_step.hpp"

#include <algorithm>

#include <Eigen/Core>

#include "systems/body/compliance/support_motion.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

/// The other regions' answers take at most three quarters of a region's own compliance away
/// (supported_regions.cpp); interpolation by support fits of different steps must not exceed that
/// either.
constexpr double kLeastPivot = 0.25;

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

/// Newton's matrix, and each region's distance du from where all loads move it. With y = K^(1/2) du
/// the equations (I + C K) du = r are (I + K^(1/2) C K^(1/2)) y = K^(1/2) r, symmetric. Fills the
/// blocks on the diagonal and right of it.
void fill_equations(const CompliantBody& body, const StiffnessRoots& roots,
                    Eigen::Map<RowMatrix>& matrix, Vector& change) {
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

/// How many regions' own compliance is more than `least` times their contacts'.
std::size_t count_soft_regions(const CompliantBody& body, const StiffnessRoots& roots,
                               double least) {
  std::size_t soft = 0;
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportFit& support_fit = support_fit_of(body, body.regions[i]);
    const Eigen::Map<const Matrix6> own(support_fit.own.data());
    const double share = (roots[i].root * own * roots[i].root).trace();
    soft += support_fit.on_layer == 0 && share > least ? 1U : 0U;
  }
  return soft;
}

/// Whether the only tool's regions count on their own friction to hold the body: their equations
/// leave out that the body gives way to their load. Regions of two tools that pinch a soft body
/// swing when they are let slip, for Newton's matrix has nothing of how their loads' places move
/// (add_sway).
bool counts_on_itself(const CompliantBody& body, const ContactLaw& law,
                      const StiffnessRoots& roots) {
  constexpr double kSoftBody = 0.5;
  return body.model.tools.size() == 1 && !law.by_cells && !law.moves_own_support &&
         count_soft_regions(body, roots, kSoftBody) > 0;
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
void find_reactions(const CompliantBody& body, const StiffnessRoots& roots,
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
              Eigen::Map<RowMatrix>& full, Vector& change) {
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

}  // namespace

NewtonStep newton_step(CompliantBody& body, ComplianceScratch& scratch) {
  NewtonStep newton;
  for (std::size_t i = 0; i < body.count; ++i) {
    newton.roots[i] = stiffness_root(body, body.regions[i]);
    newton.slips[i].slipped.setZero();
  }
  const std::size_t size = 6 * body.count;
  const auto rows = static_cast<Eigen::Index>(size);
  Eigen::Map<RowMatrix> matrix(scratch.matrix.data(), rows, rows);
  Eigen::Map<RowMatrix> full(scratch.full.data(), rows, rows);
  Eigen::Map<RowMatrix> copy(scratch.copy.data(), rows, rows);
  const ContactLaw& law = law_of(body.model, body.row);
  // Under at least two regions: one of them feels within a step how the other answers.
  const bool answers = count_soft_regions(body, newton.roots, law.answers_from) >= 2;
  newton.sways_together = answers && law.by_cells;
  if (!newton.sways_together) {
    for (std::size_t i = 0; i < body.count; ++i) {
      sway(body, body.regions[i]);
    }
  }
  Vector right = Vector::Zero(rows);
  fill_equations(body, newton.roots, matrix, right);
  if (answers) {
    Eigen::Map<RowMatrix> inverse(scratch.inverse.data(), rows, rows);
    find_reactions(body, newton.roots, matrix, copy, inverse);
  }
  if (newton.sways_together) {
    add_sway(body, matrix, newton, full, right);
    copy = full;
    newton.motion = right;
    solve_general(size, copy.data(), newton.motion.data());
  } else {
    solve_newton(
        matrix, copy, [&] { newton.motion = right; }, newton.motion);
  }
  // On other bodies no region counts on another one, or on itself, to hold the body.
  if (answers || counts_on_itself(body, law, newton.roots)) {
    if (!newton.sways_together) {
      full = matrix.selfadjointView<Eigen::Upper>();
    }
    let_slip(body, newton.roots, {matrix, full, right}, copy, newton.motion, newton.slips);
  }
  return newton;
}

}  // namespace torsion::engine
