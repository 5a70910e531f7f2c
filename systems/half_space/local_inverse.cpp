#include "systems/half_space/local_inverse.hpp"

#include <array>
#include <utility>

namespace torsion {
namespace {

constexpr std::size_t kBlockValues = 4;  // here, along x, along y, corner: the rest is symmetry

/// Gauss' elimination; the matrix is that of a positive definite one under symmetry, so it needs no
/// pivots.
std::array<double, kBlockValues> solve(
    std::array<std::array<double, kBlockValues>, kBlockValues> matrix,
    std::array<double, kBlockValues> values) {
  for (std::size_t k = 0; k < kBlockValues; ++k) {
    for (std::size_t row = k + 1; row < kBlockValues; ++row) {
      const double factor = matrix[row][k] / matrix[k][k];
      for (std::size_t column = k; column < kBlockValues; ++column) {
        matrix[row][column] -= factor * matrix[k][column];
      }
      values[row] -= factor * values[k];
    }
  }
  for (std::size_t k = kBlockValues; k-- > 0;) {
    for (std::size_t column = k + 1; column < kBlockValues; ++column) {
      values[k] -= matrix[k][column] * values[column];
    }
    values[k] /= matrix[k][k];
  }
  return values;
}

}  // namespace

LocalInverse local_inverse(const InfluenceTables& tables, InfluenceKind kind) {
  if (tables.side < 3) {
    return {1.0 / tables.self(kind), 0.0, 0.0, 0.0};
  }
  const auto at = [&](std::uint32_t columns, std::uint32_t rows) {
    return tables.of(kind)[tables.index(0, 0, columns, rows)];
  };
  const double x_corner = at(0, 1) + at(2, 1);
  const double y_corner = at(1, 0) + at(1, 2);
  const auto [here, along_x, along_y, corner] =
      solve({{{at(0, 0), 2.0 * at(1, 0), 2.0 * at(0, 1), 4.0 * at(1, 1)},
              {at(1, 0), at(0, 0) + at(2, 0), 2.0 * at(1, 1), 2.0 * x_corner},
              {at(0, 1), 2.0 * at(1, 1), at(0, 0) + at(0, 2), 2.0 * y_corner},
              {at(1, 1), x_corner, y_corner, at(0, 0) + at(2, 0) + at(0, 2) + at(2, 2)}}},
            {1.0, 0.0, 0.0, 0.0});
  return {here, along_x, along_y, corner};
}

}  // namespace torsion
