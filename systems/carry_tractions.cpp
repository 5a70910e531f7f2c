#include "systems/carry_tractions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

/// Of a cell: a grid that has moved less than this is left as it is, for every interpolation
/// smooths the tractions a little.
constexpr double kStill = 0.02;

/// From cells of the new grid, counted from 0, to cells of the old one, by fractions.
struct CellMap {
  glm::dvec2 origin;  // where cell (0, 0) of the new grid is
  glm::dvec2 x;       // what one cell along x is
  glm::dvec2 y;
};

glm::dvec2 in_old_cells(const RegionFrame& old, double side, const glm::dvec3& point) {
  const glm::dvec2 place(body_to_grid(old, point));
  return (place / old.half_size + 1.0) * (0.5 * side) - 0.5;
}

CellMap map_of(const RegionFrame& old, const RegionFrame& now, std::uint32_t side) {
  const auto place = [&](std::uint32_t i, std::uint32_t j) {
    const glm::dvec2 center = cell_center(now, side, i, j);
    return in_old_cells(old, static_cast<double>(side), grid_to_body(now, {center, 0.0}));
  };
  const glm::dvec2 origin = place(0, 0);
  const double steps = std::max(1.0, static_cast<double>(side - 1));
  return {origin, (place(side - 1, 0) - origin) / steps, (place(0, side - 1) - origin) / steps};
}

/// How far the farthest corner has moved, in cells.
double farthest_move(const CellMap& map, std::uint32_t side) {
  const auto last = static_cast<double>(side - 1);
  double farthest = 0.0;
  for (const glm::dvec2& corner : {glm::dvec2(0.0), glm::dvec2(last, 0.0), glm::dvec2(0.0, last)}) {
    const glm::dvec2 move = map.origin + map.x * corner.x + map.y * corner.y - corner;
    farthest = std::max(farthest, glm::length(move));
  }
  return farthest;
}

/// Between the four old cells around `place`; beyond the grid there is no traction.
CellTraction between(std::span<const CellTraction> old, std::uint32_t side,
                     const glm::dvec2& place) {
  const glm::dvec2 low = glm::floor(place);
  const glm::dvec2 share = place - low;
  CellTraction result;
  for (const auto& [dx, dy] : {std::array{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}) {
    const double x = low.x + dx;
    const double y = low.y + dy;
    const double last = static_cast<double>(side) - 1.0;
    if (!(x >= 0.0 && y >= 0.0 && x <= last && y <= last)) {
      continue;
    }
    const double weight =
        (dx == 0.0 ? 1.0 - share.x : share.x) * (dy == 0.0 ? 1.0 - share.y : share.y);
    const CellTraction& cell =
        old[static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)];
    result.traction += weight * cell.traction;
    result.kinetic_share += weight * cell.kinetic_share;
  }
  return result;
}

/// Turns a traction of the old grid's plane into the new one's.
glm::dvec2 turned(const RegionFrame& old, const RegionFrame& now, const glm::dvec2& traction) {
  return glm::dvec2(body_to_grid_direction(now, tangent_to_body(old, traction)));
}

void carry(StepContext& context, std::uint32_t region) {
  World& world = context.world;
  const RegionFrame& now = world.regions.at<RegionFrame>(region);
  RegionFrame& old = world.regions.at<TractionFrame>(region).frame;
  if (old.half_size.x <= 0.0) {
    old = now;
    return;
  }
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  const CellMap map = map_of(old, now, side);
  if (farthest_move(map, side) < kStill) {
    return;
  }
  const auto cells = world.cells.rows<CellTraction>(world.regions.at<RegionIdentity>(region).cells);
  const std::span<CellTraction> before(context.scratch.cell_tractions);
  std::ranges::copy(cells, before.begin());
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const glm::dvec2 place =
          map.origin + map.x * static_cast<double>(i) + map.y * static_cast<double>(j);
      CellTraction cell = between(before, side, place);
      cell.traction = turned(old, now, cell.traction);
      cells[j * side + i] = cell;
    }
  }
  old = now;
}

}  // namespace

void carry_tractions(StepContext& context) {
  for (std::uint32_t region = 0; region < context.world.regions.size(); ++region) {
    carry(context, region);
  }
}

}  // namespace torsion
