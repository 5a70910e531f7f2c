#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "systems/patch/solver.hpp"

namespace torsion::engine {
namespace {

constexpr double kPoissonRatio = 0.3;
constexpr double kCompliance = 2e-9;  // m/Pa

/// One grid's columns, (side x side) each.
struct Columns {
  std::vector<std::vector<double>> values;
  explicit Columns(std::size_t count) : values(11, std::vector<double>(count, 0.0)) {}
  PatchColumns view() {
    return {values[0], values[1], values[2], values[3], values[4], values[5],
            values[6], values[7], values[8], values[9], values[10]};
  }
};

/// The displacement (z, x, y) at a cell, each table looked up for every loaded cell by its meaning.
std::array<double, 3> looked_up(const InfluenceTables& tables, const PatchColumns& columns,
                                std::uint32_t i, std::uint32_t j) {
  std::array<double, 3> sum{};
  std::size_t source = 0;
  for (std::uint32_t source_j = 0; source_j < tables.side; ++source_j) {
    for (std::uint32_t source_i = 0; source_i < tables.side; ++source_i, ++source) {
      const std::size_t at = tables.index(source_i, source_j, i, j);
      const auto of = [&](InfluenceKind kind) {
        return kCompliance * tables.of(kind)[at];
      };
      const double p = columns.pressure[source];
      const double x = columns.traction_x[source];
      const double y = columns.traction_y[source];
      sum[0] +=
          of(InfluenceKind::kZZ) * p + of(InfluenceKind::kZX) * x + of(InfluenceKind::kZY) * y;
      sum[1] +=
          of(InfluenceKind::kXX) * x + of(InfluenceKind::kXY) * y - of(InfluenceKind::kZX) * p;
      sum[2] +=
          of(InfluenceKind::kXY) * x + of(InfluenceKind::kYY) * y - of(InfluenceKind::kZY) * p;
    }
  }
  return sum;
}

class PatchDisplacementsTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PatchDisplacementsTest, AreWhatTheTablesSayOfEveryLoadedCell) {
  const std::uint32_t side = GetParam();
  std::vector<double> values(influence_count(side));
  fill_influences(kPoissonRatio, side, values);
  Columns memory(std::size_t{side} * side);
  const PatchColumns columns = memory.view();
  std::mt19937 random(side);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (std::size_t cell = 0; cell < columns.pressure.size(); ++cell) {
    if (share(random) < 0.6) {  // some cells of every pair, row and column stay free
      columns.pressure[cell] = 1e5 * share(random);
      columns.traction_x[cell] = 1e5 * (share(random) - 0.5);
      columns.traction_y[cell] = share(random) < 0.5 ? 0.0 : 1e5 * (share(random) - 0.5);
    }
  }
  PatchProblem problem;
  problem.influences = influence_tables(values, side, 1);
  problem.compliance = kCompliance;
  problem.coupled = true;
  PatchWork work;
  work.reserve(side);
  displace_patch(problem, columns, work);
  // Rounding: at most as many sums as there are cells, of terms up to 1e5 times the compliance.
  const double bound = 1e-15 * side * side * 1e5 * kCompliance;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const std::size_t cell = std::size_t{j} * side + i;
      const auto [z, x, y] = looked_up(problem.influences, columns, i, j);
      ASSERT_NEAR(columns.depression[cell], z, bound) << i << " " << j;
      ASSERT_NEAR(columns.moved_x[cell], x, bound) << i << " " << j;
      ASSERT_NEAR(columns.moved_y[cell], y, bound) << i << " " << j;
    }
  }
}

// Odd sides, whose last row has no partner, and sides that leave a rest of every vector's width.
INSTANTIATE_TEST_SUITE_P(Sides, PatchDisplacementsTest,
                         testing::Values(1U, 2U, 3U, 6U, 7U, 12U, 15U, 24U));

}  // namespace
}  // namespace torsion::engine
