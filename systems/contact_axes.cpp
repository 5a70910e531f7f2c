#include "systems/contact_axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/frames.hpp"
#include "systems/patch_grid.hpp"

namespace torsion {
namespace {

constexpr double kLong = 1.6;  // times its width: what is longer has its grid along it
// Over the contact's width over its length: a contact that lies so far askew needs a grid twice as
// wide.
constexpr double kAskew = 1.0;
constexpr double kFewest = 5.0;  // cells along a contact, of which its axes can be told

/// Second moments over the sum of the weights, about their middle, m^2.
struct Spread {
  glm::dvec2 middle{0.0};
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
};

Spread spread_of(const Grid& grid, std::span<const double> weights) {
  double sum = 0.0;
  glm::dvec2 moment(0.0);
  Spread spread;
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const double weight = weights[cell];
      const glm::dvec2 at = cell_center(grid.frame, grid.side, i, j);
      sum += weight;
      moment += weight * at;
      spread.xx += weight * at.x * at.x;
      spread.xy += weight * at.x * at.y;
      spread.yy += weight * at.y * at.y;
    }
  }
  if (sum <= 0.0) {
    return {};
  }
  const glm::dvec2 middle = moment / sum;
  // A cell's own second moment is a twelfth of its side's square.
  const glm::dvec2 own = cell_half_size(grid) * cell_half_size(grid) / 3.0;
  return {middle, spread.xx / sum - middle.x * middle.x + own.x,
          spread.xy / sum - middle.x * middle.y, spread.yy / sum - middle.y * middle.y + own.y};
}

}  // namespace

ContactAxes contact_axes(const Grid& grid, std::span<const double> weights) {
  const Spread spread = spread_of(grid, weights);
  ContactAxes axes;
  axes.middle = spread.middle;
  axes.size = glm::sqrt(12.0 * glm::dvec2(spread.xx, spread.yy));
  const double mean = 0.5 * (spread.xx + spread.yy);
  const double half = 0.5 * (spread.xx - spread.yy);
  const double radius = std::hypot(half, spread.xy);
  const double least = std::max(mean - radius, 0.0);
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  const bool is_known = std::sqrt(12.0 * (mean + radius)) > kFewest * std::max(cell.x, cell.y);
  if (!is_known || mean + radius < kLong * kLong * least) {
    return axes;
  }
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  axes.angle = 0.5 * std::atan2(spread.xy, half);  // of the long axis from the grid's x
  const std::int32_t aspect = patch_aspect(grid.frame.half_size);
  if (aspect < 0 || (aspect == 0 && std::abs(axes.angle) > 0.5 * kQuarter)) {
    axes.angle += axes.angle > 0.0 ? -kQuarter : kQuarter;
  }
  axes.allowance = kAskew * std::sqrt(least / (mean + radius));
  return axes;
}

void turn_axes(RegionFrame& frame, double angle) {
  const glm::dvec3 x = frame.tangent_x;
  const glm::dvec3 y = frame.tangent_y;
  frame.tangent_x = std::cos(angle) * x + std::sin(angle) * y;
  frame.tangent_y = std::cos(angle) * y - std::sin(angle) * x;
}

}  // namespace torsion
