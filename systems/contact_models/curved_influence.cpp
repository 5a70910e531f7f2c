#include "systems/contact_models/curved_influence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ecs/assert.hpp"
#include "systems/contact_models/layer_influence.hpp"

namespace torsion {

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
  // Between two places of the density 1 / sqrt(1 - r^2) the mean logarithm of the distance is
  // that of the radius and minus the integral of (1 - sqrt(1 - r^2))^2 / r.
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
  constexpr double kGauss = 0.28867513459481287;  // of the cell, from its centre
  // Over the cell's length along x its area leaves its width; a quarter for each of four points.
  const double area = 0.25 * cell.y / (8.0 * std::numbers::pi);
  // The same on the other side of the force: half of the table says it all.
  for (std::size_t row = side - 1; row + 1 < width; ++row) {
    for (std::size_t column = 0; column + 1 < width; ++column) {
      const glm::dvec2 offset =
          cell * (glm::dvec2(static_cast<double>(column), static_cast<double>(row)) -
                  static_cast<double>(side - 1));
      const std::size_t at = row * width + column;
      const std::size_t opposite = (width - 2 - row) * width + (width - 2 - column);
      for (std::size_t kind = 0; kind < kCurvedKinds; ++kind) {
        double sum = 0.0;
        for (const double x : {-kGauss, kGauss}) {
          for (const double y : {-kGauss, kGauss}) {
            sum += curved_displacement(response[kind], offset + cell * glm::dvec2(x, y), reach);
          }
        }
        const double value = half_space.kinds[kind][at] + area * sum;
        values[kind * table + at] = value;
        values[kind * table + opposite] = value;
      }
    }
  }
  fill_differences(values);
}

}  // namespace torsion
