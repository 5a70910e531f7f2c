#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "systems/contact/support/support_fit.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/patch/support.hpp"

namespace torsion::engine {
namespace {

constexpr Eigen::Index kTerms = kSupportTerms;
constexpr Eigen::Index kAll = 3 * kTerms;
using TermMatrix = Eigen::Matrix<double, kTerms, kTerms, Eigen::RowMajor>;
using TangentMatrix = Eigen::Matrix<double, 2 * kTerms, 2 * kTerms, Eigen::RowMajor>;
using AllMatrix = Eigen::Matrix<double, kAll, kAll>;

constexpr std::uint32_t kDiscSide = 20;  // squares across the disc
/// The contact's ellipse has the cells' second moments. The loaded cells may reach beyond it, as a
/// rectangle's corners do, and may grow before the support is refitted.
constexpr double kHolds = 1.4;
/// At nu < 0.5 pressure and traction couple: a bonded punch is stiffer than a frictionless one, by
/// 9.9 % (ln 3) at nu = 0 (Johnson, Contact Mechanics, 1985, 3.8).
constexpr double kCoupledStiffer = 0.0986;

/// Squares whose centres lie in the disc, and the terms there.
struct DiscSquares {
  std::vector<std::array<std::uint32_t, 2>> cells;
  Eigen::MatrixXd terms;  // (squares x kTerms)
};

DiscSquares squares_in_disc() {
  DiscSquares disc;
  const auto centre = [](std::uint32_t i) {
    return (2.0 * static_cast<double>(i) + 1.0) / kDiscSide - 1.0;
  };
  for (std::uint32_t j = 0; j < kDiscSide; ++j) {
    for (std::uint32_t i = 0; i < kDiscSide; ++i) {
      if (std::hypot(centre(i), centre(j)) < 1.0) {
        disc.cells.push_back({i, j});
      }
    }
  }
  disc.terms.resize(static_cast<Eigen::Index>(disc.cells.size()), kTerms);
  for (std::size_t row = 0; row < disc.cells.size(); ++row) {
    const auto terms = support_terms({centre(disc.cells[row][0]), centre(disc.cells[row][1])});
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      disc.terms(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) = terms[k];
    }
  }
  return disc;
}

/// Displacement by a force spread over a square, multiplied by shear modulus and the disc's radius.
Eigen::MatrixXd influences_of(const DiscSquares& disc, const InfluenceTables& tables,
                              InfluenceKind kind) {
  constexpr double kLength = 2.0 / kDiscSide;
  const auto count = static_cast<Eigen::Index>(disc.cells.size());
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index to = 0; to < count; ++to) {
    for (Eigen::Index from = 0; from < count; ++from) {
      const auto& [i, j] = disc.cells[static_cast<std::size_t>(to)];
      const auto& [source_i, source_j] = disc.cells[static_cast<std::size_t>(from)];
      matrix(to, from) = tables.of(kind)[tables.index(source_i, source_j, i, j)] / kLength;
    }
  }
  return matrix;
}

/// L of Q' A^-1 Q = L L'.
Eigen::MatrixXd factor_of_stiffness(const Eigen::MatrixXd& influences,
                                    const Eigen::MatrixXd& terms) {
  const Eigen::MatrixXd stiffness = terms.transpose() * influences.llt().solve(terms);
  return stiffness.llt().matrixL();
}

/// L of S for a support fit's contact, in the support fit's axes (tangent_x, tangent_y, normal),
/// axis by axis.
AllMatrix scaled_factor(const DiscStiffness& disc, const Elasticity& elasticity,
                        const SupportFit& support_fit) {
  const double radius = std::min(kHolds * support_fit.extent, support_fit.reach);
  const double share = radius / support_fit.reach;
  const double nu = elasticity.poisson_ratio;
  const double coupled = 1.0 + kCoupledStiffer * (1.0 - 2.0 * nu);
  const double unit = std::sqrt(coupled * elasticity.shear_modulus() * radius);
  // Under pressure a half-space is stiffer by 1 / (1 - nu), here relative to nu = 0.5.
  const double along_normal = std::sqrt(0.5 / (1.0 - nu));
  const Eigen::Map<const TermMatrix> normal(disc.normal.data());
  const Eigen::Map<const TangentMatrix> tangential(disc.tangential.data());
  AllMatrix lower = AllMatrix::Zero();
  lower.topLeftCorner<2 * kTerms, 2 * kTerms>() = unit * tangential;
  lower.bottomRightCorner<kTerms, kTerms>() = unit * along_normal * normal;
  for (int row = 0; row < kAll; ++row) {
    // A term in the disc's coordinates over the one in the support fit's, to its degree.
    lower.row(row) *= std::pow(share, kSupportDegrees[static_cast<std::size_t>(row % kTerms)]);
  }
  return lower;
}

/// A response has 16 rows an axis, in body axes; this is its 45 x 45 matrix in the support fit's.
AllMatrix in_support_fit(const SupportFit& support_fit, const SupportResponse& response) {
  const std::array<glm::dvec3, 3> axes{support_fit.tangent_x, support_fit.tangent_y,
                                       support_fit.normal};
  AllMatrix half = AllMatrix::Zero();  // rows in the support fit's axes, columns in the body's
  AllMatrix matrix = AllMatrix::Zero();
  constexpr int kColumn = kSupportColumn;
  const auto value = [&response](int axis_to, int row, int axis_from, int column) {
    return response.terms[static_cast<std::size_t>(
        ((axis_from * kColumn + column) * 3 + axis_to) * kColumn + row)];
  };
  for (int to = 0; to < 3; ++to) {
    for (int body = 0; body < 3; ++body) {
      const double share = axes[static_cast<std::size_t>(to)][body];
      for (int from = 0; from < 3; ++from) {
        for (int column = 0; column < kTerms; ++column) {
          for (int row = 0; row < kTerms; ++row) {
            half(to * kTerms + row, from * kTerms + column) +=
                share * value(body, row, from, column);
          }
        }
      }
    }
  }
  for (int from = 0; from < 3; ++from) {
    for (int body = 0; body < 3; ++body) {
      matrix.middleCols<kTerms>(from * kTerms) +=
          axes[static_cast<std::size_t>(from)][body] * half.middleCols<kTerms>(body * kTerms);
    }
  }
  return 0.5 * (matrix + matrix.transpose());
}

/// response += change, which is in the support fit's axes.
void add_in_body(const SupportFit& support_fit, const AllMatrix& change,
                 SupportResponse& response) {
  const std::array<glm::dvec3, 3> axes{support_fit.tangent_x, support_fit.tangent_y,
                                       support_fit.normal};
  constexpr int kColumn = kSupportColumn;
  for (int body_to = 0; body_to < 3; ++body_to) {
    for (int body_from = 0; body_from < 3; ++body_from) {
      TermMatrix sum = TermMatrix::Zero();
      for (int to = 0; to < 3; ++to) {
        for (int from = 0; from < 3; ++from) {
          sum += axes[static_cast<std::size_t>(to)][body_to] *
                 axes[static_cast<std::size_t>(from)][body_from] *
                 change.block<kTerms, kTerms>(to * kTerms, from * kTerms);
        }
      }
      for (int column = 0; column < kTerms; ++column) {
        for (int row = 0; row < kTerms; ++row) {
          response.terms[static_cast<std::size_t>(
              ((body_from * kColumn + column) * 3 + body_to) * kColumn + row)] += sum(row, column);
        }
      }
    }
  }
}

}  // namespace

DiscStiffness make_disc_stiffness() {
  std::vector<double> values(influence_count(kDiscSide));
  fill_influences(0.5, kDiscSide, values);
  const InfluenceTables tables = influence_tables(values, kDiscSide, 0);
  const DiscSquares disc = squares_in_disc();
  DiscStiffness stiffness;
  Eigen::Map<TermMatrix>(stiffness.normal.data()) =
      factor_of_stiffness(influences_of(disc, tables, InfluenceKind::kZZ), disc.terms);
  const Eigen::Index count = disc.terms.rows();
  Eigen::MatrixXd along(2 * count, 2 * count);
  along.topLeftCorner(count, count) = influences_of(disc, tables, InfluenceKind::kXX);
  along.bottomRightCorner(count, count) = influences_of(disc, tables, InfluenceKind::kYY);
  along.topRightCorner(count, count) = influences_of(disc, tables, InfluenceKind::kXY);
  along.bottomLeftCorner(count, count) = along.topRightCorner(count, count).transpose();
  Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(2 * count, 2 * kTerms);
  terms.topLeftCorner(count, kTerms) = disc.terms;
  terms.bottomRightCorner(count, kTerms) = disc.terms;
  Eigen::Map<TangentMatrix>(stiffness.tangential.data()) = factor_of_stiffness(along, terms);
  return stiffness;
}

bool make_definite(const DiscStiffness& disc, const Elasticity& elasticity,
                   const SupportFit& support_fit, SupportResponse& response) {
  const AllMatrix lower = scaled_factor(disc, elasticity, support_fit);
  AllMatrix relative;
  relative.noalias() = in_support_fit(support_fit, response) * lower;
  relative = (lower.transpose() * relative).eval();
  AllMatrix shifted = relative;
  shifted.diagonal().array() -= kLeastResponse;
  if (const Eigen::LLT<AllMatrix> factor(shifted); factor.info() == Eigen::Success) {
    return false;
  }
  const Eigen::SelfAdjointEigenSolver<AllMatrix> solver(0.5 * (relative + relative.transpose()));
  const Eigen::Matrix<double, kAll, 1> lacking =
      (kLeastResponse - solver.eigenvalues().array()).cwiseMax(0.0);
  // L^-T V lacking V' L^-1
  const AllMatrix back =
      lower.transpose().triangularView<Eigen::Upper>().solve(solver.eigenvectors());
  AllMatrix change;
  change.noalias() = back * lacking.asDiagonal() * back.transpose();
  add_in_body(support_fit, change, response);
  return true;
}

}  // namespace torsion::engine
