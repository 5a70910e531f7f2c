#include <algorithm>
#include <array>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What was found, put back: A has eigenvalues from 1 to about 1 + n, so that rounding by 1e-16 in
// each of n steps stays below 1e-12 of the right side.
TEST(SymmetricSolveTest, SolvesForOneAndForManyRightSides) {
  std::mt19937 random(11);
  std::normal_distribution<double> value;
  for (const Eigen::Index n : {1, 2, 7, 15, 60, 96}) {
    for (const Eigen::Index width : {1, 3, 32}) {
      const RowMatrix factor = RowMatrix::NullaryExpr(n, n, [&] { return value(random); });
      const RowMatrix matrix =
          RowMatrix::Identity(n, n) + factor * factor.transpose() / static_cast<double>(n);
      const RowMatrix right = RowMatrix::NullaryExpr(n, width, [&] { return value(random); });
      RowMatrix upper = matrix;
      upper.triangularView<Eigen::StrictlyLower>().setConstant(1e300);  // is not to be read
      RowMatrix found = right;
      const auto rows = static_cast<std::size_t>(n);
      solve_symmetric(rows, rows, upper.data(), static_cast<std::size_t>(width), found.data(),
                      0.25);
      EXPECT_LT((matrix * found - right).norm(), 1e-12 * right.norm()) << n << " x " << width;
    }
  }
}

// The second pivot is what the first leaves of the diagonal, 1 - c^2; negative where an eigenvalue
// is (Sylvester's law of inertia).
TEST(SymmetricSolveTest, TellsOfAMatrixThatIsNotDefinite) {
  for (const double coupling : {0.0, 0.5, 0.99, 1.01, 1e3}) {
    std::array matrix{1.0, coupling, coupling, 1.0};
    std::array right{1.0, 0.0};
    const double smallest = solve_symmetric(2, 2, matrix.data(), 1, right.data(), 0.25);
    EXPECT_DOUBLE_EQ(smallest, std::min(1.0, 1.0 - coupling * coupling));
  }
}

// Rows that have to be exchanged, a first pivot of zero among them. An elimination with exchanges
// is off by the matrix' condition times 1e-16 times a growth of some n; the worst of these draws
// has a condition of some 1e4.
TEST(GeneralSolveTest, SolvesWhereRowsHaveToBeExchanged) {
  std::mt19937 random(12);
  std::normal_distribution<double> value;
  for (const Eigen::Index n : {2, 3, 12, 60, 96}) {
    RowMatrix matrix = RowMatrix::NullaryExpr(n, n, [&] { return value(random); });
    matrix.diagonal().setZero();
    const Eigen::VectorXd expected = Eigen::VectorXd::NullaryExpr(n, [&] { return value(random); });
    Eigen::VectorXd found = matrix * expected;
    solve_general(static_cast<std::size_t>(n), RowMatrix(matrix).data(), found.data());
    EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm()) << n;
  }
}

TEST(GeneralSolveTest, OfASingularMatrixFindsNothingFinite) {
  RowMatrix matrix = RowMatrix::Ones(3, 3);
  Eigen::VectorXd found = Eigen::Vector3d(1.0, 2.0, 3.0);
  solve_general(3, matrix.data(), found.data());
  EXPECT_FALSE(found.allFinite());
}

}  // namespace
}  // namespace torsion::engine
