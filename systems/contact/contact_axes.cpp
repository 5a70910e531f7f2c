#include "systems/contact/contact_axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/half_space/influence.hpp"

namespace torsion {

double SecondMoments::width_over_length() const {
  const double mean = 0.5 * (xx + yy);
  const double radius = std::hypot(0.5 * (xx - yy), xy);
  return mean > 0.0 ? std::sqrt(std::max(mean - radius, 0.0) / (mean + radius)) : 1.0;
}

CellMoments covered_moments(const Grid& grid) {
  CellMoments moments;
  const double* coverage = grid.scratch.cell_columns.coverage.data();
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++coverage) {
      moments.add(*coverage, static_cast<double>(i), static_cast<double>(j));
    }
  }
  return moments;
}

ContactAxes contact_axes(const Grid& grid, const CellMoments& moments) {
  constexpr double kFewest = 5.0;  // cells along a contact, of which its axes can be told
  ContactAxes axes;
  if (moments.weight <= 0.0) {
    return axes;
  }
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  const glm::dvec2 middle = glm::dvec2(moments.x, moments.y) / moments.weight;
  axes.middle = cell * (middle + 0.5) - grid.frame.half_size;
  // A cell's own second moment is a twelfth of its side's square.
  const SecondMoments second{
      (moments.xx / moments.weight - middle.x * middle.x + 1.0 / 12.0) * cell.x * cell.x,
      (moments.xy / moments.weight - middle.x * middle.y) * cell.x * cell.y,
      (moments.yy / moments.weight - middle.y * middle.y + 1.0 / 12.0) * cell.y * cell.y};
  axes.size = glm::sqrt(12.0 * glm::dvec2(second.xx, second.yy));
  const double slender = second.width_over_length();
  const double most = std::max(axes.size.x, axes.size.y);
  if (most < kFewest * std::max(cell.x, cell.y) || kLongContact * slender > 1.0) {
    return axes;
  }
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  axes.angle = second.angle();
  const std::int32_t aspect = table_aspect(grid.frame.half_size);
  if (aspect < 0 || (aspect == 0 && std::abs(axes.angle) > 0.5 * kQuarter)) {
    axes.angle += axes.angle > 0.0 ? -kQuarter : kQuarter;
  }
  axes.allowance = slender;
  return axes;
}

void turn_axes(RegionFrame& frame, double angle) {
  const glm::dvec3 x = frame.tangent_x;
  const glm::dvec3 y = frame.tangent_y;
  frame.tangent_x = std::cos(angle) * x + std::sin(angle) * y;
  frame.tangent_y = std::cos(angle) * y - std::sin(angle) * x;
}

}  // namespace torsion
