#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/geometric.hpp>

#include "ecs/components.hpp"

namespace torsion {

/// A cell of a region's grid: i along x, j along y.
struct CellPlace {
  std::uint32_t i;
  std::uint32_t j;
};

/// Finds the cell of a region's grid over or under which a point lies.
struct CellFinder {
  /// @param along  cells along each side
  CellFinder(const RegionFrame& of, std::uint32_t along)
      : frame(of),
        side(along),
        cells_over_length(0.5 * static_cast<double>(along) / of.half_size) {}

  /// @param point  m, body; none where it is beside the grid, or NaN
  [[nodiscard]] std::optional<CellPlace> under(const glm::dvec3& point) const {
    const glm::dvec3 offset = point - frame.origin;
    const double x = glm::dot(offset, frame.tangent_x);
    const double y = glm::dot(offset, frame.tangent_y);
    // Written so that NaN is in no cell.
    if (!(std::abs(x) <= frame.half_size.x && std::abs(y) <= frame.half_size.y)) {
      return std::nullopt;
    }
    return CellPlace{at(x * cells_over_length.x), at(y * cells_over_length.y)};
  }

  const RegionFrame& frame;
  std::uint32_t side;
  glm::dvec2 cells_over_length;  // 1/m

 private:
  /// @param from_middle  in cells; rounding may put it beside the grid
  [[nodiscard]] std::uint32_t at(double from_middle) const {
    const double from_edge = from_middle + 0.5 * static_cast<double>(side);
    return static_cast<std::uint32_t>(std::clamp(from_edge, 0.0, static_cast<double>(side - 1)));
  }
};

}  // namespace torsion
