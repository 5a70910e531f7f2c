#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "systems/half_space/influence.hpp"
#include "systems/patch/passes.hpp"
#include "tests/systems/patch/local_inverse_at.hpp"

namespace torsion::engine {
namespace {

using test::local_inverse_at;

TEST(LocalInverseTest, UndoesTheInfluencesWithinThreeByThreeCells) {
  constexpr std::uint32_t kSide = 12;
  std::vector<double> values(influence_count(kSide));
  fill_influences(0.3, kSide, values);
  for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
    const InfluenceTables tables = influence_tables(values, kSide, aspect);
    for (const InfluenceKind kind : {InfluenceKind::kXX, InfluenceKind::kYY, InfluenceKind::kZZ}) {
      const LocalInverse inverse = local_inverse(tables, kind);
      for (std::uint32_t to = 0; to < 9; ++to) {
        double displacement = 0.0;
        for (std::uint32_t from = 0; from < 9; ++from) {
          displacement += tables.of(kind)[tables.index(from % 3, from / 3, to % 3, to / 3)] *
                          local_inverse_at(inverse, static_cast<int>(from % 3) - 1,
                                           static_cast<int>(from / 3) - 1);
        }
        EXPECT_NEAR(displacement, to == 4 ? 1.0 : 0.0, 1e-13) << aspect << " " << to;
      }
    }
  }
}

class LocalInverseOnGridTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(LocalInverseOnGridTest, AsksEveryCellAndItsNeighbours) {
  const std::uint32_t side = GetParam();
  const LocalInverse inverse{3.0, -0.7, -0.4, 0.11};
  constexpr double kScale = 2.5;
  const std::size_t count = whole_lanes(std::size_t{side} * side);
  std::mt19937 random(side);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> values(count, 0.0);
  for (std::size_t cell = 0; cell < std::size_t{side} * side; ++cell) {
    values[cell] = uniform(random);
  }
  std::vector<double> bordered(std::size_t{side + 2} * (side + 2) + kLanes, 0.0);
  to_border(side, values.data(), bordered.data());
  std::vector<double> product(count, 0.0);
  apply_local_inverse(inverse, kScale, side, bordered.data(), product.data());
  double form = 0.0;
  const auto cells = static_cast<int>(side);
  for (int to = 0; to < cells * cells; ++to) {
    double sum = 0.0;
    for (int from = 0; from < cells * cells; ++from) {
      sum += kScale * values[static_cast<std::size_t>(from)] *
             local_inverse_at(inverse, to % cells - from % cells, to / cells - from / cells);
    }
    EXPECT_NEAR(product[static_cast<std::size_t>(to)], sum, 1e-14) << to;
    form += values[static_cast<std::size_t>(to)] * sum;
  }
  // Sums of up to 256 products that are below 25.
  EXPECT_NEAR(quadratic_form(inverse, kScale, side, bordered.data()), form, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Sides, LocalInverseOnGridTest, testing::Values(1, 3, 7, 8, 9, 12, 16));

}  // namespace
}  // namespace torsion::engine
