#include "systems/math/dense_cholesky.hpp"

#include <algorithm>
#include <cmath>

#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

constexpr std::size_t kRowsAtOnce = 6;    // of sums that hide each other's latency
constexpr std::size_t kRowsOfBlock = 48;  // blocks of A that stay in the nearer caches
constexpr std::size_t kInnerAtOnce = 96;
constexpr std::size_t kSmallTriangle = 24;  // rows that are not worth a recursion

/// `Rows` rows of eight columns of C.
/// @param stored  how many of the columns are written, the last ones
template <class Wide, std::size_t Rows>
TORSION_LANES void subtract_tile(std::size_t inner, const MatrixPlace& a, const RowsPlace& b,
                                 const RowsPlace& c, std::size_t stored) {
  Wide sums[Rows];
  for (std::size_t r = 0; r < Rows; ++r) {
    sums[r] = lanes_at<Wide>(c.first + r * c.stride);
  }
  for (std::size_t k = 0; k < inner; ++k) {
    const Wide row = lanes_at<Wide>(b.first + k * b.stride);
    const double* const factors = a.first + k * a.column_stride;
    for (std::size_t r = 0; r < Rows; ++r) {
      sums[r] -= factors[r * a.row_stride] * row;
    }
  }
  const std::size_t skipped = kLanes - stored;
  for (std::size_t r = 0; r < Rows; ++r) {
    double* const out = c.first + r * c.stride;
    if (skipped == 0) {
      store_lanes(sums[r], out);
    } else {
      double lanes[kLanes];
      store_lanes(sums[r], lanes);
      std::copy(lanes + skipped, lanes + kLanes, out + skipped);
    }
  }
}

/// All rows of eight columns of C.
template <class Wide>
TORSION_LANES void subtract_columns(std::size_t rows, std::size_t inner, const MatrixPlace& a,
                                    const RowsPlace& b, const RowsPlace& c, std::size_t stored) {
  std::size_t row = 0;
  const auto rows_of_a = [&] {
    return MatrixPlace{a.first + row * a.row_stride, a.row_stride, a.column_stride};
  };
  for (; row + kRowsAtOnce <= rows; row += kRowsAtOnce) {
    subtract_tile<Wide, kRowsAtOnce>(inner, rows_of_a(), b, {c.first + row * c.stride, c.stride},
                                     stored);
  }
  for (; row < rows; ++row) {
    subtract_tile<Wide, 1>(inner, rows_of_a(), b, {c.first + row * c.stride, c.stride}, stored);
  }
}

/// All columns of C, of which there are eight or more. Those beside whole vectors are found in one
/// that ends with the last of them.
template <class Wide>
TORSION_LANES void subtract_block(std::size_t rows, std::size_t inner, std::size_t width,
                                  const MatrixPlace& a, const RowsPlace& b, const RowsPlace& c) {
  std::size_t column = 0;
  for (; column + kLanes <= width; column += kLanes) {
    subtract_columns<Wide>(rows, inner, a, {b.first + column, b.stride},
                           {c.first + column, c.stride}, kLanes);
  }
  if (column < width) {
    subtract_columns<Wide>(rows, inner, a, {b.first + width - kLanes, b.stride},
                           {c.first + width - kLanes, c.stride}, width - column);
  }
}

template <class Wide>
TORSION_LANES void subtract_wide(std::size_t rows, std::size_t inner, std::size_t width,
                                 const MatrixPlace& a, const RowsPlace& b, const RowsPlace& c) {
  for (std::size_t k = 0; k < inner; k += kInnerAtOnce) {
    for (std::size_t row = 0; row < rows; row += kRowsOfBlock) {
      const double* const first = a.first + row * a.row_stride + k * a.column_stride;
      subtract_block<Wide>(std::min(kRowsOfBlock, rows - row), std::min(kInnerAtOnce, inner - k),
                           width, {first, a.row_stride, a.column_stride},
                           {b.first + k * b.stride, b.stride},
                           {c.first + row * c.stride, c.stride});
    }
  }
}

/// A product of fewer than eight columns.
void subtract_narrow(std::size_t rows, std::size_t inner, std::size_t width, const MatrixPlace& a,
                     const RowsPlace& b, const RowsPlace& c) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < inner; ++k) {
      const double factor = a.first[row * a.row_stride + k * a.column_stride];
      for (std::size_t column = 0; column < width; ++column) {
        c.first[row * c.stride + column] -= factor * b.first[k * b.stride + column];
      }
    }
  }
}

/// X becomes L^-1 X, row by row.
TORSION_WIDEST void solve_small(std::size_t n, const double* lower, std::size_t stride,
                                std::size_t width, const RowsPlace& x) {
  for (std::size_t row = 0; row < n; ++row) {
    double* const out = x.first + row * x.stride;
    for (std::size_t k = 0; k < row; ++k) {
      const double factor = lower[k * stride + row];
      const double* const above = x.first + k * x.stride;
      for (std::size_t column = 0; column < width; ++column) {
        out[column] -= factor * above[column];
      }
    }
    const double inverse = 1.0 / lower[row * stride + row];
    for (std::size_t column = 0; column < width; ++column) {
      out[column] *= inverse;
    }
  }
}

TORSION_WIDEST void solve_small_transposed(std::size_t n, const double* lower, std::size_t stride,
                                           std::size_t width, const RowsPlace& x) {
  for (std::size_t row = n; row-- > 0;) {
    double* const out = x.first + row * x.stride;
    for (std::size_t k = row + 1; k < n; ++k) {
      const double factor = lower[row * stride + k];
      const double* const under = x.first + k * x.stride;
      for (std::size_t column = 0; column < width; ++column) {
        out[column] -= factor * under[column];
      }
    }
    const double inverse = 1.0 / lower[row * stride + row];
    for (std::size_t column = 0; column < width; ++column) {
      out[column] *= inverse;
    }
  }
}

TORSION_WIDEST bool factor_small(std::size_t n, double* matrix, std::size_t stride) {
  for (std::size_t column = 0; column < n; ++column) {
    double* const pivots = matrix + column * stride;
    if (!(pivots[column] > 0.0)) {
      return false;
    }
    const double root = std::sqrt(pivots[column]);
    pivots[column] = root;
    for (std::size_t row = column + 1; row < n; ++row) {
      pivots[row] /= root;
    }
    for (std::size_t next = column + 1; next < n; ++next) {
      double* const out = matrix + next * stride;
      const double factor = pivots[next];
      for (std::size_t row = next; row < n; ++row) {
        out[row] -= factor * pivots[row];
      }
    }
  }
  return true;
}

/// About half of n, a multiple of what is done at once.
std::size_t half_of(std::size_t n) {
  return (n / 2 + kSmallTriangle - 1) / kSmallTriangle * kSmallTriangle;
}

}  // namespace

void subtract_product(std::size_t rows, std::size_t inner, std::size_t width, const MatrixPlace& a,
                      const RowsPlace& b, const RowsPlace& c) {
  if (width < kLanes) {
    subtract_narrow(rows, inner, width, a, b, c);
  } else {
    TORSION_IN_WIDEST(subtract_wide, rows, inner, width, a, b, c);
  }
}

void subtract_square(std::size_t n, std::size_t inner, const double* a, double* c,
                     std::size_t stride) {
  // A column of a matrix that is stored by columns is a row of its transpose.
  auto* const rows = const_cast<double*>(a);
  if (n <= 2 * kSmallTriangle) {
    subtract_product(n, inner, n, {a, 1, stride}, {rows, stride}, {c, stride});
    return;
  }
  const std::size_t half = half_of(n);
  subtract_square(half, inner, a, c, stride);
  subtract_product(half, inner, n - half, {a, 1, stride}, {rows + half, stride},
                   {c + half, stride});
  subtract_square(n - half, inner, a + half, c + half * stride + half, stride);
}

void solve_lower(std::size_t n, const double* lower, std::size_t stride, std::size_t width,
                 const RowsPlace& x) {
  if (n <= kSmallTriangle) {
    solve_small(n, lower, stride, width, x);
    return;
  }
  const std::size_t half = half_of(n);
  const RowsPlace rest{x.first + half * x.stride, x.stride};
  solve_lower(half, lower, stride, width, x);
  subtract_product(n - half, half, width, {lower + half, 1, stride}, x, rest);
  solve_lower(n - half, lower + half * stride + half, stride, width, rest);
}

void solve_lower_transposed(std::size_t n, const double* lower, std::size_t stride,
                            std::size_t width, const RowsPlace& x) {
  if (n <= kSmallTriangle) {
    solve_small_transposed(n, lower, stride, width, x);
    return;
  }
  const std::size_t half = half_of(n);
  const RowsPlace rest{x.first + half * x.stride, x.stride};
  solve_lower_transposed(n - half, lower + half * stride + half, stride, width, rest);
  subtract_product(half, n - half, width, {lower + half, stride, 1}, rest, x);
  solve_lower_transposed(half, lower, stride, width, x);
}

bool factor_cholesky(std::size_t n, double* matrix, std::size_t stride) {
  if (n <= kSmallTriangle) {
    return factor_small(n, matrix, stride);
  }
  const std::size_t half = half_of(n);
  if (!factor_cholesky(half, matrix, stride)) {
    return false;
  }
  solve_lower(half, matrix, stride, n - half, {matrix + half, stride});
  double* const rest = matrix + half * stride + half;
  subtract_square(n - half, half, matrix + half, rest, stride);
  return factor_cholesky(n - half, rest, stride);
}

}  // namespace torsion::engine
