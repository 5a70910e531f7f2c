#include "systems/carry_tractions.hpp"

#include <algorithm>
#include <cmath>

#include "systems/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

/// Of a cell: a grid that has moved less than this is left as it is, for every interpolation
/// smooths the tractions a little.
constexpr double kStill = 1e-4;

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

CarriedCell mix(const CarriedCell& a, const CarriedCell& b, double share) {
  return {a.per_cell + share * (b.per_cell - a.per_cell),
          a.coverage + share * (b.coverage - a.coverage),
          a.kinetic_share + share * (b.kinetic_share - a.kinetic_share)};
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

/// A copy of the old cells with a border without traction, so that no tap falls outside. Tractions
/// are per area of contact, so they count with its coverage.
void copy_with_border(std::span<const CellTraction> cells, std::uint32_t side,
                      std::span<CarriedCell> copy) {
  std::ranges::fill(copy, CarriedCell{});
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const CellTraction& cell = cells[j * side + i];
      copy[(j + 1) * (side + 2) + i + 1] = {cell.coverage * cell.traction, cell.coverage,
                                            cell.kinetic_share};
    }
  }
}

/// Between the four old cells around `place`.
CarriedCell between(std::span<const CarriedCell> old, std::uint32_t side, glm::dvec2 place) {
  place = glm::clamp(place + 1.0, glm::dvec2(0.0), glm::dvec2(static_cast<double>(side) + 0.999));
  const auto i = static_cast<std::uint32_t>(place.x);
  const auto j = static_cast<std::uint32_t>(place.y);
  const double x = place.x - static_cast<double>(i);
  const double y = place.y - static_cast<double>(j);
  const CarriedCell* at = &old[std::size_t{j} * (side + 2) + i];
  const CarriedCell low = mix(at[0], at[1], x);
  const CarriedCell high = mix(at[side + 2], at[side + 3], x);
  return mix(low, high, y);
}

/// What is new of a cell's contact has no traction: spread over all of it there is less.
void dilute(CellTraction& cell, double coverage) {
  if (coverage > cell.coverage) {
    cell.traction *= cell.coverage / coverage;
  }
  cell.coverage = coverage;
}

/// Turns a traction of the old grid's plane into the new one's.
glm::dvec2 turned(const RegionFrame& old, const RegionFrame& now, const glm::dvec2& traction) {
  return glm::dvec2(body_to_grid_direction(now, tangent_to_body(old, traction)));
}

/// Gives each cell that is in contact the traction of the place where it is.
void follow_grid(StepContext& context, const CellMap& map, const RegionFrame& old,
                 const RegionFrame& now, Range rows) {
  const std::uint32_t side = context.world.settings.at<Settings>(0).grid_side;
  const auto cells = context.world.cells.rows<CellTraction>(rows);
  const auto geometry = context.world.cells.rows<CellGeometry>(rows);
  const std::span<CarriedCell> before(context.scratch.carried_cells);
  copy_with_border(cells, side, before);
  const glm::dvec2 turn_x = turned(old, now, {1.0, 0.0});
  const glm::dvec2 turn_y = turned(old, now, {0.0, 1.0});
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      if (geometry[cell].coverage <= 0.0) {
        cells[cell] = CellTraction{};
        continue;
      }
      const CarriedCell carried =
          between(before, side,
                  map.origin + map.x * static_cast<double>(i) + map.y * static_cast<double>(j));
      const double inverse = carried.coverage > 0.0 ? 1.0 / carried.coverage : 0.0;
      const glm::dvec2 traction = carried.per_cell * inverse;
      cells[cell].traction = turn_x * traction.x + turn_y * traction.y;
      cells[cell].coverage = carried.coverage;
      cells[cell].kinetic_share = carried.kinetic_share;
    }
  }
}

void carry(StepContext& context, std::uint32_t region) {
  World& world = context.world;
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  const Range rows = world.regions.at<RegionIdentity>(region).cells;
  const auto cells = world.cells.rows<CellTraction>(rows);
  const RegionFrame& now = world.regions.at<RegionFrame>(region);
  RegionFrame& old = world.regions.at<TractionFrame>(region).frame;
  if (old.half_size.x <= 0.0) {
    old = now;
  }
  const CellMap map = map_of(old, now, side);
  if (farthest_move(map, side) >= kStill) {
    follow_grid(context, map, old, now, rows);
    old = now;
  }
  const auto geometry = world.cells.rows<CellGeometry>(rows);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    dilute(cells[cell], geometry[cell].coverage);
  }
}

}  // namespace

void carry_tractions(StepContext& context) {
  for (std::uint32_t region = 0; region < context.world.regions.size(); ++region) {
    const std::uint32_t body = context.world.regions.at<RegionIdentity>(region).body;
    if (context.world.bodies.at<BodyModels>(body).contact == ContactModel::kPaper) {
      carry(context, region);
    }
  }
}

}  // namespace torsion
