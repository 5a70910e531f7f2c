#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ecs/components.hpp"

namespace torsion {

/// A cell of a region's grid: i along x, j along y.
struct CellPlace {
  std::uint32_t i;
  std::uint32_t j;
};

/// Finds the cell of a region's grid over or under which a point lies.
struct CellFinder {
  /// @param grid       in its body's frame, moved as the material under it: points of a tool that
  ///                   has twisted its contact lie over other places of the grid at rest
  /// @param half_size  m, of the grid
  /// @param along      cells along each side
  CellFinder(const Pose& grid, const glm::dvec2& half_size, std::uint32_t along)
      : origin(grid.position),
        tangent_x(grid.rotation * glm::dvec3(1.0, 0.0, 0.0)),
        tangent_y(grid.rotation * glm::dvec3(0.0, 1.0, 0.0)),
        half(half_size),
        side(along),
        cells_over_length(0.5 * static_cast<double>(along) / half_size) {}

  /// @param point  m, body
  /// @return along the grid's axes, m
  [[nodiscard]] glm::dvec2 place(const glm::dvec3& point) const {
    const glm::dvec3 offset = point - origin;
    return {glm::dot(offset, tangent_x), glm::dot(offset, tangent_y)};
  }

  /// @param point  m, body; none where it is beside the grid, or NaN
  [[nodiscard]] std::optional<CellPlace> under(const glm::dvec3& point) const {
    const glm::dvec2 at = place(point);
    // Written so that NaN is in no cell.
    if (!(std::abs(at.x) <= half.x && std::abs(at.y) <= half.y)) {
      return std::nullopt;
    }
    return CellPlace{index(at.x * cells_over_length.x), index(at.y * cells_over_length.y)};
  }

  glm::dvec3 origin;  // m, body
  glm::dvec3 tangent_x;
  glm::dvec3 tangent_y;
  glm::dvec2 half;  // m
  std::uint32_t side;
  glm::dvec2 cells_over_length;  // 1/m

 private:
  /// @param from_middle  in cells; rounding may put it beside the grid
  [[nodiscard]] std::uint32_t index(double from_middle) const {
    const double from_edge = from_middle + 0.5 * static_cast<double>(side);
    return static_cast<std::uint32_t>(std::clamp(from_edge, 0.0, static_cast<double>(side - 1)));
  }
};

}  // namespace torsion
