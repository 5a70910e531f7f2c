#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "systems/half_space/influence.hpp"
#include "systems/half_space/sum_influence_block.hpp"

namespace torsion::engine {
namespace {

/// A grid with tractions on some of its cells, and what they displace by one table.
class Sums {
 public:
  explicit Sums(std::uint32_t side) : side_(side), values_(influence_count(side)) {
    fill_influences(0.3, side, values_);
    tables_ = influence_tables(values_, side, 1);
    std::mt19937 random(side);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    const std::uint32_t above = side > 1 ? 1 : 0;
    for (std::uint32_t row = 0; row < side; row += 2) {
      const PairedRows rows = paired_rows(side, row);
      for (std::uint32_t i = 0; i < side; ++i) {
        const double first = rows.first * share(random);
        const double second = rows.second * share(random);
        if (share(random) < 0.2) {
          continue;
        }
        places_.push_back(rows.row * static_cast<std::uint32_t>(tables_.width()) + i);
        scales_.insert(scales_.end(), {first, second});
        sources_.push_back({i, rows.row, first});
        sources_.push_back({i, rows.row + above, second});
      }
    }
    for (std::uint32_t cell = 0; cell < pitch() * side; ++cell) {
      start_.push_back(share(random));
    }
  }

  [[nodiscard]] std::uint32_t pitch() const { return side_ + 3; }
  [[nodiscard]] GridBlock block() const {
    return {side_, pitch(), tables_.width(), tables_.index(0, 0, 0, 0)};
  }
  [[nodiscard]] InfluenceSources sources() const {
    return {places_.data(), static_cast<std::uint32_t>(places_.size())};
  }

  /// What the sums come to; 5 where there is no cell.
  /// @param by  (InfluenceSums) sums
  /// @param start  a displacement a cell, or none
  template <class By>
  [[nodiscard]] std::vector<double> sum_by(const By& by, const double* start) const {
    std::vector<double> displacement(start_.size(), 5.0);
    by(InfluenceSums{block(), sources(), tables_.of(InfluenceKind::kZX), scales_.data(), start,
                     displacement.data()});
    return displacement;
  }
  [[nodiscard]] const double* start() const { return start_.data(); }

  /// @param by  (InfluenceSums) sums
  template <class By>
  void expect_right(const By& by) const {
    const double* const table = tables_.of(InfluenceKind::kZX);
    for (const double* const start : {static_cast<const double*>(nullptr), start_.data()}) {
      const std::vector<double> displacement = sum_by(by, start);
      for (std::uint32_t j = 0; j < side_; ++j) {
        for (std::uint32_t i = 0; i < side_; ++i) {
          const std::size_t cell = std::size_t{j} * pitch() + i;
          double sum = start != nullptr ? start[cell] : 0.0;
          double size = std::abs(sum);
          for (const auto& [source_i, source_j, scale] : sources_) {
            const double term = scale * table[tables_.index(source_i, source_j, i, j)];
            sum += term;
            size += std::abs(term);
          }
          // Every sum of n terms is off by at most n half units of the sum of their sizes.
          const double count = 1.0 + static_cast<double>(sources_.size());
          ASSERT_NEAR(displacement[cell], sum, 2.3e-16 * count * size)
              << side_ << ": " << i << " " << j;
        }
        for (std::uint32_t i = side_; i < pitch(); ++i) {
          ASSERT_EQ(displacement[std::size_t{j} * pitch() + i], 5.0);
        }
      }
    }
  }

 private:
  struct Source {
    std::uint32_t i, j;
    double scale;
  };
  std::uint32_t side_;
  std::vector<double> values_;
  InfluenceTables tables_;
  std::vector<std::uint32_t> places_;
  std::vector<double> scales_;
  std::vector<Source> sources_;
  std::vector<double> start_;
};

/// Sides that leave every rest of every vector's width, and of every number of rows at a time. A
/// single cell has no vectors; PatchDisplacementsTest has it.
class SumInfluenceTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(SumInfluenceTest, IsTheSumOverAllSources) {
  Sums(GetParam()).expect_right([](const InfluenceSums& of) {
    sum_influence(of.block, of.sources, of.table, of.scales, of.start, of.displacement);
  });
}

TEST_P(SumInfluenceTest, IsTheSameInVectorsOfEveryWidth) {
  const Sums sums(GetParam());
  sums.expect_right([](const InfluenceSums& of) { influence_block::sum_all<2>(of); });
  sums.expect_right([](const InfluenceSums& of) { influence_block::sum_all<4>(of); });
  sums.expect_right([](const InfluenceSums& of) { influence_block::sum_all<8>(of); });
#if defined(__x86_64__) && defined(__GNUC__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    sums.expect_right(sum_influence_avx2);
  }
#endif
}

#if defined(__x86_64__) && defined(__GNUC__)
// A cell's sum is one lane's, whatever the number of lanes: results do not tell the two apart
// (docs/architecture.md, Determinism).
TEST_P(SumInfluenceTest, HasTheSameBitsWithAvx2AndAvx512) {
  if (__builtin_cpu_supports("avx512f") == 0) {
    GTEST_SKIP() << "this processor has no AVX-512";
  }
  const Sums sums(GetParam());
  for (const double* const start : {static_cast<const double*>(nullptr), sums.start()}) {
    EXPECT_EQ(sums.sum_by(sum_influence_avx2, start), sums.sum_by(sum_influence_avx512, start));
  }
}
#endif

INSTANTIATE_TEST_SUITE_P(Sides, SumInfluenceTest, testing::Range(2U, 27U));

}  // namespace
}  // namespace torsion::engine
