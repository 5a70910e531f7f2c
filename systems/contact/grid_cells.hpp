#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ecs/components.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {

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

/// One region's cells and what finding them needs of the tables.
struct Grid {
  const Model& model;
  State& state;
  ContactScratch& scratch;
  RegionIdentity identity;
  RegionFrame& frame;
  RegionCarrier& carrier;
  const RegionSupport& support;
  std::uint32_t side;
  std::span<CellGeometry> cells;
};

inline Grid grid_of(StepContext& context, std::uint32_t region) {
  const Model& model = context.model;
  State& state = context.state;
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  return {model,
          state,
          context.scratch,
          identity,
          state.regions.at<RegionFrame>(region),
          state.regions.at<RegionCarrier>(region),
          state.regions.at<RegionSupport>(region),
          model.settings.grid_side,
          state.cells.rows<CellGeometry>(identity.cells)};
}

inline glm::dvec2 cell_half_size(const Grid& grid) {
  return grid.frame.half_size / static_cast<double>(grid.side);
}

inline std::span<const ContactPoint> points_of(const ContactScratch& scratch,
                                               const RegionPoints& contact) {
  return {scratch.points.data() + contact.points.first, contact.points.count};
}

/// The grid's frame in that of its body.
Pose grid_in_body(const RegionFrame& frame);

/// Where the material under a grid has gone, in the frame of its body: with what sticks to the
/// tool, and with the body as a whole.
Pose moved_grid_in_body(const RegionFrame& frame, const RegionCarrier& carrier,
                        const RegionSupport& support);

/// Finds cells by places that the material under them has moved to.
inline CellFinder finder_of(const Grid& grid) {
  return {moved_grid_in_body(grid.frame, grid.carrier, grid.support), grid.frame.half_size,
          grid.side};
}

/// The grid's frame, moved as the material under it, in that of its tool.
Pose grid_in_tool(const Grid& grid);

/// Where the centres of all cells are, m, grid.
/// @param x, y  (side x side) out
void cell_centers(const RegionFrame& frame, std::uint32_t side, std::span<double> x,
                  std::span<double> y);

/// Cells as bits: bit i of word j is cell (i, j).
using CellBits = std::array<std::uint64_t, kMaxGridSide>;

/// Adds to `bits` their neighbours of `free`, those across a corner too, and takes them from it.
/// @return true when there were any
bool spread_one_step(std::uint32_t side, CellBits& free, CellBits& bits);

/// The cells with coverage. Leaves that in ContactScratch::cell_columns.
CellBits covered_cells(const Grid& grid);

/// Smallest cosine between a surface's normal and the grid's that is divided by.
inline constexpr double kSteepest = 0.25;

/// Cosine from which facing_share is 1.
inline constexpr double kFullyFacing = 0.5;

/// How much a cell's nearest face of the body counts as the one that the tool presses on: 1 while
/// it faces the grid, 0 where it is the body's side, beside an edge or deep down.
/// @param slope  cosine between that face's normal and the grid's
inline double facing_share(double slope) {
  return smooth_step(4.0 * slope - 1.0);
}

/// The share of a cell where the depth is positive, to first order.
/// @param across  m: how much the depth changes across the cell
inline double share_below(double depth, double across) {
  return 2.0 * std::abs(depth) >= across ? (depth > 0.0 ? 1.0 : 0.0) : 0.5 + depth / across;
}

/// How much a face lies askew of the grid, 0 to 1.
/// @param slope  cosine between that face's normal and the grid's
inline double askew_share(double slope) {
  constexpr double kStraight = 0.9;
  constexpr double kAskew = 0.8;
  return smooth_step((kStraight - slope) / (kStraight - kAskew));
}

/// Finds, for every cell of the grid, the tool's surface along the normal, how deep it lies under
/// the body's rest surface, and the share of the cell that is in contact. Cells that are not joined
/// to the region's own contact points belong to a neighbour and get coverage 0. Leaves in
/// ContactScratch::cell_columns the body's distances at the cells' points, depths and coverage.
/// @return the cells with coverage
CellBits find_cells(const Grid& grid, const RegionPoints& contact);

/// Area, depths, centroid and mean normal from the cells.
Overlap summarize_cells(const Grid& grid);

}  // namespace torsion::engine
