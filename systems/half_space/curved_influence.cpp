#include "systems/half_space/curved_influence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ecs/assert.hpp"
#include "systems/half_space/layer.hpp"

namespace torsion::engine {
namespace {

/// The functions that a CurvedKind's terms are multiplied by.
struct AngularWaves {
  double log = 0.0;  // of r / reach
  double cos_2 = 0.0;
  double sin_2 = 0.0;
  double cos_4 = 0.0;
  double sin_4 = 0.0;
};

/// Their means over a cell, from four points (Gauss).
/// @param offset  m: the cell's middle from the force
AngularWaves mean_waves(const glm::dvec2& offset, const glm::dvec2& cell, double reach) {
  constexpr double kGauss = 0.28867513459481287;  // of the cell, from its centre
  AngularWaves mean;
  double product = 1.0;  // one logarithm says them all
  for (const double along_x : {-kGauss, kGauss}) {
    for (const double along_y : {-kGauss, kGauss}) {
      const double x = offset.x + along_x * cell.x;
      const double y = offset.y + along_y * cell.y;
      const double square = x * x + y * y;
      const double cos_2 = (x * x - y * y) / square;
      const double sin_2 = 2.0 * x * y / square;
      product *= square / (reach * reach);
      mean.cos_2 += 0.25 * cos_2;
      mean.sin_2 += 0.25 * sin_2;
      mean.cos_4 += 0.25 * (cos_2 * cos_2 - sin_2 * sin_2);
      mean.sin_4 += 0.5 * sin_2 * cos_2;
    }
  }
  mean.log = 0.125 * std::log(product);
  return mean;
}

}  // namespace

CurvedResponse curved_response(const SurfaceCurvature& curvature, double poisson_ratio) {
  const double n = 1.0 - 2.0 * poisson_ratio;
  const double n2 = n * n;
  const double quarter = (3.0 - n - n2) / 16.0;
  const double x = curvature.xx;
  const double y = curvature.yy;
  const double mixed = curvature.xy;
  CurvedResponse response;
  response[0] = {n2 * (x + y), 0.0, 0.5 * n2 * (x - y), n2 * mixed, 0.0, 0.0};
  response[1] = {0.25 * ((9.0 - 3.0 * n + n2) * x + (3.0 - n + 3.0 * n2) * y),
                 0.25 * n * (x - y),
                 0.5 * ((3.0 - n) * x - n2 * y),
                 0.5 * (3.0 - n + n2) * mixed,
                 quarter * (x - y),
                 2.0 * quarter * mixed};
  response[2] = {8.0 * quarter * mixed,   0.5 * n * mixed,        0.0,
                 4.0 * quarter * (x + y), -2.0 * quarter * mixed, quarter * (x - y)};
  response[3] = {0.25 * ((9.0 - 3.0 * n + n2) * y + (3.0 - n + 3.0 * n2) * x),
                 0.25 * n * (y - x),
                 0.5 * (n2 * x - (3.0 - n) * y),
                 0.5 * (3.0 - n + n2) * mixed,
                 quarter * (y - x),
                 -2.0 * quarter * mixed};
  return response;
}

double curved_displacement(const CurvedKind& kind, const glm::dvec2& offset, double reach) {
  const double xx = offset.x * offset.x;
  const double yy = offset.y * offset.y;
  const double square = xx + yy;
  const double cos_2 = (xx - yy) / square;
  const double sin_2 = 2.0 * offset.x * offset.y / square;
  return kind.steady - 0.5 * kind.log * std::log(square / (reach * reach)) + kind.cos_2 * cos_2 +
         kind.sin_2 * sin_2 + kind.cos_4 * (cos_2 * cos_2 - sin_2 * sin_2) +
         kind.sin_4 * 2.0 * sin_2 * cos_2;
}

double curved_mean(const CurvedKind& kind, double radius, double reach) {
  // The mean logarithm of the distance between two places with the density 1 / sqrt(1 - r^2) is
  // that of the radius minus the integral of (1 - sqrt(1 - r^2))^2 / r.
  constexpr double kLogOfMean = 2.0 * std::numbers::ln2 - 1.5;
  return kind.steady + kind.log * (std::log(reach / radius) - kLogOfMean);
}

void fill_curved_influences(const InfluenceTables& half_space, const CurvedResponse& response,
                            const glm::dvec2& cell, double reach, std::span<double> values) {
  const std::size_t side = half_space.side;
  TORSION_ASSERT(values.size() == layer_influence_count(half_space.side));
  const std::size_t width = half_space.width();
  const std::size_t table = values.size() / kInfluenceKinds;
  for (std::size_t kind = 0; kind < kSolvedKinds; ++kind) {
    std::copy_n(half_space.kinds[kind], table, &values[kind * table]);
  }
  // The cell's area over its length along x, which leaves its width.
  const double area = cell.y / (8.0 * std::numbers::pi);
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      const AngularWaves waves = mean_waves(
          cell * glm::dvec2(static_cast<double>(i), static_cast<double>(j)), cell, reach);
      for (std::size_t kind = 0; kind < kCurvedKinds; ++kind) {
        const CurvedKind& by = response[kind];
        const double even =
            by.steady - by.log * waves.log + by.cos_2 * waves.cos_2 + by.cos_4 * waves.cos_4;
        const double odd = by.sin_2 * waves.sin_2 + by.sin_4 * waves.sin_4;
        double* const to = &values[kind * table];
        const double* const from = half_space.kinds[kind];
        // The same value, to the last bit, on the opposite side of the force.
        const auto put = [&](std::size_t row, std::size_t column, double value) {
          const std::size_t at = row * width + column;
          const std::size_t opposite = (width - 2 - row) * width + (width - 2 - column);
          to[at] = to[opposite] = from[at] + area * value;
        };
        put(side - 1 + j, side - 1 + i, even + odd);
        put(side - 1 + j, side - 1 - i, even - odd);
      }
    }
  }
  fill_differences(values);
}

}  // namespace torsion::engine
