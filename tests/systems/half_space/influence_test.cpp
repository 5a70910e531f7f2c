#include "systems/half_space/influence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reference/exact/quadrature.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

constexpr std::uint32_t kTableSide = 12;

/// Displacements at a place (x, y) off a unit point load on a half-space with G = 1, z into the
/// body. Source: Boussinesq's and Cerruti's solutions, Johnson, Contact Mechanics, 1985, (3.18) and
/// (3.75).
double point_load(InfluenceKind kind, double nu, double x, double y) {
  const double square = x * x + y * y;
  const double distance = std::sqrt(square);
  const double cube = square * distance;
  switch (kind) {
    case InfluenceKind::kZZ:
      return (1.0 - nu) / (2.0 * pi * distance);
    case InfluenceKind::kXX:
      return ((1.0 - nu) / distance + nu * x * x / cube) / (2.0 * pi);
    case InfluenceKind::kXY:
      return nu * x * y / (2.0 * pi * cube);
    case InfluenceKind::kYY:
      return ((1.0 - nu) / distance + nu * y * y / cube) / (2.0 * pi);
    case InfluenceKind::kZX:
      return (1.0 - 2.0 * nu) * x / (4.0 * pi * square);
    case InfluenceKind::kZY:
      return (1.0 - 2.0 * nu) * y / (4.0 * pi * square);
    case InfluenceKind::kXXLessXY:
      return ((1.0 - nu) / distance + nu * x * (x - y) / cube) / (2.0 * pi);
    case InfluenceKind::kYYLessXY:
      return ((1.0 - nu) / distance + nu * y * (y - x) / cube) / (2.0 * pi);
  }
  return 0.0;
}

/// A rectangle with these half sides under a uniform unit traction.
struct Rectangle {
  double half_x = 0.0;
  double half_y = 0.0;
};

/// The point load's displacements integrated over the rectangle, seen from (x, y) outside of it, in
/// pieces that are nearly square: beside a long one the kernel's pole would be but a small part of
/// the rule's interval away. Error: under 1e-11.
double integrated(InfluenceKind kind, double nu, const Rectangle& cell, double x, double y) {
  const auto pieces_along = [](double half, double other) {
    return std::max(1, static_cast<int>(std::ceil(half / other)));
  };
  const int count_x = pieces_along(cell.half_x, cell.half_y);
  const int count_y = pieces_along(cell.half_y, cell.half_x);
  const Rectangle piece{cell.half_x / count_x, cell.half_y / count_y};
  const auto along_x = reference::gauss_legendre(40, -piece.half_x, piece.half_x);
  const auto along_y = reference::gauss_legendre(40, -piece.half_y, piece.half_y);
  double sum = 0.0;
  for (int j = 0; j < count_y; ++j) {
    for (int i = 0; i < count_x; ++i) {
      const double from_x = x + cell.half_x - (2 * i + 1) * piece.half_x;
      const double from_y = y + cell.half_y - (2 * j + 1) * piece.half_y;
      sum += reference::integrate(along_y, [&](double source_y) {
        return reference::integrate(along_x, [&](double source_x) {
          return point_load(kind, nu, from_x - source_x, from_y - source_y);
        });
      });
    }
  }
  return sum;
}

/// The same at the rectangle's own centre: in polar coordinates the distance cancels the
/// singularity, and what is left is the ray's length times the kernel at distance 1. What is odd
/// along one axis cancels.
double integrated_at_centre(InfluenceKind kind, double nu, const Rectangle& cell) {
  switch (kind) {
    case InfluenceKind::kXY:
    case InfluenceKind::kZX:
    case InfluenceKind::kZY:
      return 0.0;
    case InfluenceKind::kXXLessXY:
      return integrated_at_centre(InfluenceKind::kXX, nu, cell);
    case InfluenceKind::kYYLessXY:
      return integrated_at_centre(InfluenceKind::kYY, nu, cell);
    default:
      break;
  }
  const double corner = std::atan2(cell.half_y, cell.half_x);
  const auto ray = [&](double angle) {
    const double length =
        angle < corner ? cell.half_x / std::cos(angle) : cell.half_y / std::sin(angle);
    return length * point_load(kind, nu, std::cos(angle), std::sin(angle));
  };
  return 4.0 * (reference::integrate(reference::gauss_legendre(40, 0.0, corner), ray) +
                reference::integrate(reference::gauss_legendre(40, corner, 0.5 * pi), ray));
}

constexpr InfluenceKind kKinds[] = {
    InfluenceKind::kZZ, InfluenceKind::kXX, InfluenceKind::kXY,       InfluenceKind::kYY,
    InfluenceKind::kZX, InfluenceKind::kZY, InfluenceKind::kXXLessXY, InfluenceKind::kYYLessXY};

std::vector<double> filled(double nu) {
  std::vector<double> values(influence_count(kTableSide));
  fill_influences(nu, kTableSide, values);
  return values;
}

/// The table's value at a cell `di` columns and `dj` rows away from the loaded one.
double at(const InfluenceTables& tables, InfluenceKind kind, int di, int dj) {
  const auto source = [](int d) {
    return static_cast<std::uint32_t>(d < 0 ? kTableSide - 1 : 0);
  };
  const auto moved = [](std::uint32_t from, int d) {
    return static_cast<std::uint32_t>(static_cast<int>(from) + d);
  };
  const std::uint32_t i = source(di);
  const std::uint32_t j = source(dj);
  return tables.of(kind)[tables.index(i, j, moved(i, di), moved(j, dj))];
}

TEST(InfluenceTest, QuadratureOfThePointLoadMatchesAPrintedSample) {
  // Anchors the integrals that the tables are compared with: printed to nine digits, a rectangle
  // of 0.6 x 0.4 seen from (0.9, -0.4), nu = 0.3, G = 1.
  const Rectangle cell{0.3, 0.2};
  const double x = 0.9;
  const double y = -0.4;
  EXPECT_NEAR(integrated(InfluenceKind::kXX, 0.3, cell, x, y), 0.037385611, 5.1e-10);
  EXPECT_NEAR(integrated(InfluenceKind::kXY, 0.3, cell, x, y), -0.00434418152, 5.1e-12);
  EXPECT_NEAR(integrated(InfluenceKind::kYY, 0.3, cell, x, y), 0.0299048932, 5.1e-11);
  EXPECT_NEAR(integrated(InfluenceKind::kZZ, 0.3, cell, x, y), 0.0277078547, 5.1e-11);
  EXPECT_NEAR(integrated(InfluenceKind::kZX, 0.3, cell, x, y), 0.0071321815, 5.1e-11);
}

TEST(InfluenceTest, EveryNearCellHoldsTheIntegralOfThePointLoad) {
  for (const double nu : {0.0, 0.3, 0.45, 0.5}) {
    const std::vector<double> values = filled(nu);
    for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
      const InfluenceTables tables = influence_tables(values, kTableSide, aspect);
      const double width = std::ldexp(1.0, -aspect);  // along y, in lengths along x
      const Rectangle cell{0.5, 0.5 * width};
      for (const InfluenceKind kind : kKinds) {
        for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {0, 1}, {-1, 2}, {3, -2}, {-4, -5}}) {
          const double expected = di == 0 && dj == 0 ? integrated_at_centre(kind, nu, cell)
                                                     : integrated(kind, nu, cell, di, dj * width);
          EXPECT_NEAR(at(tables, kind, di, dj), expected, 5e-9 * width)
              << nu << " aspect " << aspect << " kind " << static_cast<int>(kind) << " at " << di
              << " " << dj;
        }
      }
    }
  }
}

TEST(InfluenceTest, FarCellsSeeAPointLoad) {
  const std::vector<double> values = filled(0.3);
  const InfluenceTables tables = influence_tables(values, kTableSide, 0);
  for (const auto& [di, dj] : {std::pair{8, 3}, {-9, 9}, {11, -11}, {-7, -10}}) {
    for (const InfluenceKind kind : kKinds) {
      // The next term of the expansion is the cell's second moment, h^2 / 12 each way, times
      // second derivatives that are at most 6 / r^2 of 1 / (2 pi r).
      const double square = di * di + dj * dj;
      const double bound = 0.5 / square / (2.0 * pi * std::sqrt(square));
      EXPECT_NEAR(at(tables, kind, di, dj), point_load(kind, 0.3, di, dj), bound);
    }
  }
}

TEST(InfluenceTest, TheSameWorkIsDoneEitherWayRound) {
  // Betti: the displacement at B by a traction at A is that at A by the same traction at B, and
  // the pressure's sideways push is the pull's rise with its sign changed. With one table for all
  // pairs of equal cells this is a symmetry in the offset.
  const std::vector<double> values = filled(0.3);
  for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
    const InfluenceTables tables = influence_tables(values, kTableSide, aspect);
    const int reach = static_cast<int>(kTableSide) - 1;
    for (int di = -reach; di <= reach; ++di) {
      for (int dj = -reach; dj <= reach; ++dj) {
        for (const InfluenceKind kind : kKinds) {
          const bool odd = kind == InfluenceKind::kZX || kind == InfluenceKind::kZY;
          const double there = at(tables, kind, di, dj);
          const double back = at(tables, kind, -di, -dj);
          // The corner sums cancel: rounding is that of the corners, rho <= 50 times 1e-16.
          ASSERT_NEAR(there, odd ? -back : back, 1e-13) << di << " " << dj;
        }
      }
    }
  }
}

TEST(InfluenceTest, IncompressiblePressureMovesNothingSideways) {
  const std::vector<double> values = filled(0.5);
  const InfluenceTables tables = influence_tables(values, kTableSide, 1);
  const int reach = static_cast<int>(kTableSide) - 1;
  for (int di = -reach; di <= reach; ++di) {
    for (int dj = -reach; dj <= reach; ++dj) {
      EXPECT_EQ(at(tables, InfluenceKind::kZX, di, dj), 0.0);
      EXPECT_EQ(at(tables, InfluenceKind::kZY, di, dj), 0.0);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
