#include "systems/half_space/layer_influence.hpp"

#include <array>

#include "ecs/assert.hpp"
#include "systems/half_space/layer_kernel.hpp"

namespace torsion {
namespace {

/// Mean over a cell at `offset` from a force, in the order of InfluenceKind.
std::array<double, kSolvedKinds> mean_response(std::span<const double> kernel, double poisson_ratio,
                                               const glm::dvec2& offset, const glm::dvec2& cell) {
  constexpr double kGauss = 0.28867513459481287;  // of the cell, from its centre
  std::array<double, kSolvedKinds> sum{};
  for (const double x : {-kGauss, kGauss}) {
    for (const double y : {-kGauss, kGauss}) {
      const LayerResponse at =
          layer_response(kernel, poisson_ratio, offset + cell * glm::dvec2(x, y));
      const std::array<double, kSolvedKinds> kinds{at.zz, at.xx, at.xy, at.yy, at.zx, at.zy};
      for (std::size_t kind = 0; kind < kSolvedKinds; ++kind) {
        sum[kind] += 0.25 * kinds[kind];
      }
    }
  }
  return sum;
}

}  // namespace

void fill_layer_influences(const InfluenceTables& half_space, std::span<const double> kernel,
                           double poisson_ratio, const glm::dvec2& cell, std::span<double> values) {
  const std::uint32_t side = half_space.side;
  TORSION_ASSERT(values.size() == layer_influence_count(side));
  const std::size_t width = half_space.width();
  const std::size_t table = values.size() / kInfluenceKinds;
  // Signs under x -> -x and y -> -y, in the order of InfluenceKind.
  constexpr std::array<double, kSolvedKinds> kOddInX{1.0, 1.0, -1.0, 1.0, -1.0, 1.0};
  constexpr std::array<double, kSolvedKinds> kOddInY{1.0, 1.0, -1.0, 1.0, 1.0, -1.0};
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const auto response = mean_response(kernel, poisson_ratio, cell * glm::dvec2(i, j), cell);
      for (std::size_t kind = 0; kind < kSolvedKinds; ++kind) {
        // Over the cell's length along x: its area leaves its width.
        const double value = response[kind] * cell.y;
        for (const bool left : {false, true}) {
          for (const bool below : {false, true}) {
            const std::size_t row = below ? side - 1 - j : side - 1 + j;
            const std::size_t column = left ? side - 1 - i : side - 1 + i;
            const std::size_t at = row * width + column;
            values[kind * table + at] =
                half_space.kinds[kind][at] +
                value * (left ? kOddInX[kind] : 1.0) * (below ? kOddInY[kind] : 1.0);
          }
        }
      }
    }
  }
  fill_differences(values);
}

InfluenceTables layer_influence_tables(std::span<const double> values, std::uint32_t side) {
  TORSION_ASSERT(values.size() == layer_influence_count(side));
  InfluenceTables tables;
  tables.side = side;
  for (std::size_t kind = 0; kind < kInfluenceKinds; ++kind) {
    tables.kinds[kind] = values.data() + kind * (values.size() / kInfluenceKinds);
  }
  return tables;
}

}  // namespace torsion
