#pragma once

// Dense products and triangular solutions of some hundred rows, in the widest vectors of the
// machine and with the same bits on all (lanes.hpp). Eigen's are compiled for the least machine and
// cut their sums by the sizes of the processor's caches.

#include <cstddef>

namespace torsion::engine {

/// A matrix somewhere in memory: its first number, and how far apart rows and columns are.
struct MatrixPlace {
  const double* first = nullptr;
  std::size_t row_stride = 0;
  std::size_t column_stride = 0;
};

/// Rows of numbers that follow each other in memory.
struct RowsPlace {
  double* first = nullptr;
  std::size_t stride = 0;  // from one row to the next
};

/// C -= A B, every sum in the order of its terms.
/// @param a      (rows x inner)
/// @param b      (inner x width), not written
/// @param c      (rows x width), elsewhere than A and B
void subtract_product(std::size_t rows, std::size_t inner, std::size_t width, const MatrixPlace& a,
                      const RowsPlace& b, const RowsPlace& c);

/// C -= A A', the lower triangle: above the diagonal, numbers near it are overwritten without a
/// meaning.
/// @param a  (n x inner) column by column, `stride` apart
/// @param c  (n x n) likewise
void subtract_square(std::size_t n, std::size_t inner, const double* a, double* c,
                     std::size_t stride);

/// The lower triangle of a symmetric matrix becomes L, with L L' the matrix; above the diagonal,
/// numbers near it are overwritten without a meaning.
/// @param matrix  (n x n) column by column, `stride` apart
/// @return false where a pivot is not above 0; then the matrix is of no use
/// Source: Golub & Van Loan, Matrix Computations (4th ed.), 4.2.9: by recursive blocks.
[[nodiscard]] bool factor_cholesky(std::size_t n, double* matrix, std::size_t stride);

/// X becomes L^-1 X.
/// @param lower  (n x n) column by column, `stride` apart; its upper triangle is not read
/// @param x      (n x width)
void solve_lower(std::size_t n, const double* lower, std::size_t stride, std::size_t width,
                 const RowsPlace& x);

/// X becomes L'^-1 X, likewise.
void solve_lower_transposed(std::size_t n, const double* lower, std::size_t stride,
                            std::size_t width, const RowsPlace& x);

}  // namespace torsion::engine
