#include "systems/half_space/influence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "ecs/assert.hpp"

namespace torsion::engine {
namespace {

/// y ln(x + rho), with x + rho written so that no digits are lost where x is negative.
double y_log_x_plus_rho(double x, double y, double rho) {
  const double sum = x > 0.0 ? x + rho : y * y / (rho - x);
  return y == 0.0 ? 0.0 : y * std::log(sum);
}

/// The four integrals at a corner; their alternating sums are the integrals over a rectangle.
struct Integrals {
  double x2 = 0.0;  // of x^2 / rho^3
  double y2 = 0.0;  // of y^2 / rho^3
  double xy = 0.0;  // of x y / rho^3
  double x = 0.0;   // of x / rho^2
  double y = 0.0;   // of y / rho^2
};

Integrals corner(double x, double y) {
  const double rho = std::hypot(x, y);
  Integrals at;
  at.x2 = y_log_x_plus_rho(x, y, rho);
  at.y2 = y_log_x_plus_rho(y, x, rho);
  at.xy = -rho;
  at.x = (y == 0.0 ? 0.0 : y * std::log(rho)) + (x == 0.0 ? 0.0 : x * std::atan(y / x));
  at.y = (x == 0.0 ? 0.0 : x * std::log(rho)) + (y == 0.0 ? 0.0 : y * std::atan(x / y));
  return at;
}

/// Over the rectangle of the given half sides around (x, y).
Integrals rectangle(double x, double y, double half_x, double half_y) {
  const Integrals a = corner(x + half_x, y + half_y);
  const Integrals b = corner(x - half_x, y + half_y);
  const Integrals c = corner(x + half_x, y - half_y);
  const Integrals d = corner(x - half_x, y - half_y);
  return {a.x2 - b.x2 - c.x2 + d.x2, a.y2 - b.y2 - c.y2 + d.y2, a.xy - b.xy - c.xy + d.xy,
          a.x - b.x - c.x + d.x, a.y - b.y - c.y + d.y};
}

}  // namespace

void fill_influences(double poisson_ratio, std::uint32_t side, std::span<double> values) {
  TORSION_ASSERT(values.size() == influence_count(side));
  const double shear = 1.0 / (2.0 * std::numbers::pi);
  const double coupling = (1.0 - 2.0 * poisson_ratio) / (4.0 * std::numbers::pi);
  const std::size_t table = (2 * std::size_t{side} - 1) * (2 * std::size_t{side});
  std::size_t first = 0;
  for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
    const double height = std::ldexp(1.0, -aspect);  // of a cell that is 1 long
    std::size_t next = first;
    for (std::uint32_t row = 0; row + 1 < 2 * side; ++row) {
      for (std::uint32_t column = 0; column < 2 * side; ++column, ++next) {
        const double x = static_cast<double>(column) - static_cast<double>(side - 1);
        const double y = (static_cast<double>(row) - static_cast<double>(side - 1)) * height;
        const Integrals over = rectangle(x, y, 0.5, 0.5 * height);
        const double both = over.x2 + over.y2;  // of 1 / rho
        const std::array<double, kSolvedKinds> kinds{
            shear * (1.0 - poisson_ratio) * both,
            shear * ((1.0 - poisson_ratio) * both + poisson_ratio * over.x2),
            shear * poisson_ratio * over.xy,
            shear * ((1.0 - poisson_ratio) * both + poisson_ratio * over.y2),
            coupling * over.x,
            coupling * over.y};
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
          values[next + kind * table] = kinds[kind];
        }
      }
    }
    fill_differences(values.subspan(first, kInfluenceKinds * table));
    first += kInfluenceKinds * table;
  }
}

void fill_differences(std::span<double> values) {
  const std::size_t table = values.size() / kInfluenceKinds;
  const auto of = [&](InfluenceKind kind) {
    return values.subspan(static_cast<std::size_t>(kind) * table, table);
  };
  const std::span<const double> mixed = of(InfluenceKind::kXY);
  std::ranges::transform(of(InfluenceKind::kXX), mixed, of(InfluenceKind::kXXLessXY).begin(),
                         std::minus<>{});
  std::ranges::transform(of(InfluenceKind::kYY), mixed, of(InfluenceKind::kYYLessXY).begin(),
                         std::minus<>{});
}

InfluenceTables influence_tables(std::span<const double> values, std::uint32_t side,
                                 std::int32_t aspect) {
  TORSION_ASSERT(values.size() == influence_count(side));
  const std::size_t table = (2 * std::size_t{side} - 1) * (2 * std::size_t{side});
  const auto place = static_cast<std::size_t>(aspect + kMostAspect);
  InfluenceTables tables;
  tables.side = side;
  for (std::size_t kind = 0; kind < kInfluenceKinds; ++kind) {
    tables.kinds[kind] = values.data() + (place * kInfluenceKinds + kind) * table;
  }
  return tables;
}

std::int32_t table_aspect(const glm::dvec2& half_size) {
  const double ratio = std::log2(half_size.x / half_size.y);
  return static_cast<std::int32_t>(
      std::clamp(std::round(ratio), -1.0 * kMostAspect, 1.0 * kMostAspect));
}

glm::dvec2 tabulated_half_size(const glm::dvec2& least, std::int32_t aspect) {
  const double ratio = std::ldexp(1.0, aspect);
  const double half = std::max(least.x, least.y * ratio);
  return {half, half / ratio};
}

glm::dvec2 tabulated_half_size(const glm::dvec2& least) {
  return tabulated_half_size(least, table_aspect(least));
}

namespace {

constexpr std::size_t kBlockValues = 4;  // here, along x, along y, corner: the rest is symmetry

/// Gauss' elimination. The matrix is a positive definite one reduced by symmetry: no pivots are
/// needed.
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

}  // namespace torsion::engine
