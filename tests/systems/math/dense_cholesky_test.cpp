#include "systems/math/dense_cholesky.hpp"

#include <limits>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kRounding = 1.2e-16;  // of one operation, relative
constexpr double kUnread = 1e300;      // where nothing may be read

std::size_t size(Eigen::Index n) {
  return static_cast<std::size_t>(n);
}

/// Numbers of the normal distribution.
class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  RowMatrix rows(Eigen::Index rows, Eigen::Index columns) {
    return RowMatrix::NullaryExpr(rows, columns, [&] { return value_(random_); });
  }
  Eigen::MatrixXd columns(Eigen::Index n, Eigen::Index columns) { return rows(n, columns); }
  /// Eigenvalues from 1 on.
  Eigen::MatrixXd definite(Eigen::Index n) {
    const RowMatrix factor = rows(n, n);
    return RowMatrix::Identity(n, n) + factor * factor.transpose() / static_cast<double>(n);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> value_;
};

// A sum of n terms is off by at most n roundings of the sum of their sizes (Higham, Accuracy and
// Stability of Numerical Algorithms, 3.1). Sizes beside whole vectors, whole groups of rows and
// whole blocks; numbers outside of the three parts must stay.
TEST(DenseProductTest, IsTheSumOfItsTermsWhateverTheSizes) {
  Random random(21);
  for (const Eigen::Index rows : {1, 6, 7, 48, 51, 100}) {
    for (const Eigen::Index inner : {1, 5, 96, 97, 200}) {
      for (const Eigen::Index width : {1, 3, 7, 8, 9, 48, 53}) {
        const RowMatrix a = random.rows(rows, inner);
        const RowMatrix b = random.rows(inner, width + 2);
        RowMatrix c = random.rows(rows, width + 5);
        RowMatrix expected = c;
        expected.leftCols(width) -= a.lazyProduct(b.leftCols(width));
        const RowMatrix sizes =
            c.leftCols(width).cwiseAbs() + a.cwiseAbs().lazyProduct(b.leftCols(width).cwiseAbs());
        RowMatrix kept = b;
        subtract_product(size(rows), size(inner), size(width), {a.data(), size(inner), 1},
                         {kept.data(), size(width + 2)}, {c.data(), size(width + 5)});
        ASSERT_EQ(kept, b);
        ASSERT_EQ(c.rightCols(5), expected.rightCols(5));
        ASSERT_LE(((c - expected).leftCols(width).cwiseAbs() -
                   2.0 * static_cast<double>(inner + 1) * kRounding * sizes)
                      .maxCoeff(),
                  0.0)
            << rows << " x " << inner << " x " << width;
      }
    }
  }
}

TEST(DenseProductTest, TakesAMatrixByItsColumnsAsWell) {
  Random random(22);
  const RowMatrix a = random.rows(33, 70);
  const Eigen::MatrixXd by_columns = a;
  RowMatrix b = random.rows(70, 21);
  RowMatrix first = RowMatrix::Zero(33, 21);
  RowMatrix second = first;
  subtract_product(33, 70, 21, {a.data(), 70, 1}, {b.data(), 21}, {first.data(), 21});
  subtract_product(33, 70, 21, {by_columns.data(), 1, 33}, {b.data(), 21}, {second.data(), 21});
  EXPECT_EQ(first, second);
}

// L L' differs from the matrix by at most n + 1 roundings of |L| |L'| (Higham, 10.1.1), whatever
// the order of the sums. In a larger matrix: what is beside it is neither read nor written.
TEST(DenseCholeskyTest, PutsTheMatrixBackTogether) {
  Random random(23);
  for (const Eigen::Index n : {1, 2, 3, 23, 24, 25, 47, 48, 49, 96, 150, 311}) {
    const Eigen::MatrixXd matrix = random.definite(n);
    Eigen::MatrixXd place = Eigen::MatrixXd::Constant(n + 4, n, kUnread);
    place.topRows(n).triangularView<Eigen::Lower>() = matrix;
    ASSERT_TRUE(factor_cholesky(size(n), place.data(), size(n + 4)));
    EXPECT_EQ(place.bottomRows(4), Eigen::MatrixXd::Constant(4, n, kUnread));
    const Eigen::MatrixXd lower = place.topRows(n).triangularView<Eigen::Lower>();
    const Eigen::MatrixXd sizes = lower.cwiseAbs().lazyProduct(lower.transpose().cwiseAbs());
    EXPECT_LE(((lower.lazyProduct(lower.transpose()) - matrix).cwiseAbs() -
               2.0 * static_cast<double>(n + 1) * kRounding * sizes)
                  .maxCoeff(),
              0.0)
        << n;
  }
}

// Negative where an eigenvalue is (Sylvester's law of inertia), first in the last of many rows.
TEST(DenseCholeskyTest, SaysWhereAMatrixIsNotDefinite) {
  Random random(24);
  for (const Eigen::Index n : {1, 2, 24, 25, 100}) {
    Eigen::MatrixXd matrix = random.definite(n);
    matrix(n - 1, n - 1) = -1.0;
    EXPECT_FALSE(factor_cholesky(size(n), matrix.data(), size(n))) << n;
    matrix.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(factor_cholesky(size(n), matrix.data(), size(n))) << n;
  }
}

// Each row of L X = B holds up to n roundings of |L| |X| (Higham, 8.5).
TEST(TriangularSolveTest, SolvesWithTheFactorAndWithItsTranspose) {
  Random random(25);
  for (const Eigen::Index n : {1, 3, 24, 25, 48, 96, 130}) {
    for (const Eigen::Index width : {1, 3, 8, 13, 48}) {
      Eigen::MatrixXd lower = random.definite(n);
      ASSERT_TRUE(factor_cholesky(size(n), lower.data(), size(n)));
      lower.triangularView<Eigen::StrictlyUpper>().setConstant(kUnread);  // is not to be read
      const Eigen::MatrixXd l = lower.triangularView<Eigen::Lower>();
      const Eigen::MatrixXd transposed = l.transpose();
      const RowMatrix right = random.rows(n, width);
      for (const bool transpose : {false, true}) {
        RowMatrix found = right;
        const RowsPlace x{found.data(), size(width)};
        if (transpose) {
          solve_lower_transposed(size(n), lower.data(), size(n), size(width), x);
        } else {
          solve_lower(size(n), lower.data(), size(n), size(width), x);
        }
        const Eigen::MatrixXd& matrix = transpose ? transposed : l;
        const RowMatrix sizes = matrix.cwiseAbs().lazyProduct(found.cwiseAbs());
        EXPECT_LE(((matrix.lazyProduct(found) - right).cwiseAbs() -
                   2.0 * static_cast<double>(n + 1) * kRounding * sizes)
                      .maxCoeff(),
                  0.0)
            << n << " x " << width << (transpose ? ", transposed" : "");
      }
    }
  }
}

}  // namespace
}  // namespace torsion::engine
