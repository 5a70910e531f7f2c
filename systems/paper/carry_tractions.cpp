#include "systems/paper/carry_tractions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

/// Of a cell. A grid that has moved less is not interpolated, because every interpolation smooths
/// the tractions a little.
constexpr double kStill = 1e-4;

/// Maps cells of the new grid, counted from 0, to cells of the old one, with fractions.
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

/// Copies the old cells within a border without traction, so that interpolation never reads
/// outside. Tractions are per area of contact, so they are multiplied by their coverage.
/// @param copy  its border is zero and stays zero
void copy_with_border(std::span<const CellTraction> cells, std::uint32_t side,
                      std::span<CarriedCell> copy) {
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const CellTraction& cell = cells[j * side + i];
      copy[(j + 1) * (side + 2) + i + 1] = {cell.coverage * cell.traction, cell.coverage,
                                            cell.kinetic_share};
    }
  }
}

/// A row of the new grid.
struct CarriedRow {
  std::array<std::uint32_t, kMaxGridSide> corner;  // the lowest of the four old cells around
  std::array<double, kMaxGridSide> x, y;           // shares of the way to the next ones
  std::array<CarriedCell, kMaxGridSide> carried;
};

/// Places of the row's cells in the old grid, which has a border of one cell.
/// @param first  the row's first cell
TORSION_WIDEST
void locate(const glm::dvec2& first, const glm::dvec2& along, std::uint32_t side,
            CarriedRow& __restrict row) {
  const double last = static_cast<double>(side) + 0.999;
  const double first_x = first.x + 1.0;
  const double first_y = first.y + 1.0;
  const double along_x = along.x;
  const double along_y = along.y;
  const int width = static_cast<int>(side) + 2;
  for (int i = 0; i < static_cast<int>(side); ++i) {
    const double x = larger(first_x + along_x * static_cast<double>(i), 0.0);
    const double y = larger(first_y + along_y * static_cast<double>(i), 0.0);
    const double inside_x = x < last ? x : last;
    const double inside_y = y < last ? y : last;
    const int column = static_cast<int>(inside_x);
    const int line = static_cast<int>(inside_y);
    const auto at = static_cast<std::size_t>(i);
    row.x[at] = inside_x - static_cast<double>(column);
    row.y[at] = inside_y - static_cast<double>(line);
    row.corner[at] = static_cast<std::uint32_t>(line * width + column);
  }
}

/// Interpolates between the four old cells around each cell of the row.
TORSION_WIDEST
void mix_row(const CarriedCell* old, std::uint32_t side, CarriedRow& __restrict row) {
  for (std::uint32_t i = 0; i < side; ++i) {
    const CarriedCell* low = old + row.corner[i];
    const CarriedCell* high = low + side + 2;
    const double x = row.x[i];
    const CarriedCell below = low[0] + x * (low[1] - low[0]);
    const CarriedCell above = high[0] + x * (high[1] - high[0]);
    row.carried[i] = below + row.y[i] * (above - below);
  }
}

/// Turns a traction from the old grid's plane to the new one's.
glm::dvec2 turned(const RegionFrame& old, const RegionFrame& now, const glm::dvec2& traction) {
  return glm::dvec2(body_to_grid_direction(now, tangent_to_body(old, traction)));
}

/// Each cell in contact takes the traction of its place. Newly covered parts of a cell have no
/// traction, so the cell's mean falls.
void follow_grid(StepContext& context, const CellMap& map, const RegionFrame& old,
                 const RegionFrame& now, Range rows) {
  const std::uint32_t side = context.model.settings.grid_side;
  const auto cells = context.state.cells.rows<CellTraction>(rows);
  const auto geometry = context.state.cells.rows<CellGeometry>(rows);
  const std::span<CarriedCell> before(context.paper.carried_cells);
  copy_with_border(cells, side, before);
  const glm::dvec2 turn_x = turned(old, now, {1.0, 0.0});
  const glm::dvec2 turn_y = turned(old, now, {0.0, 1.0});
  CarriedRow row;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    locate(map.origin + map.y * static_cast<double>(j), map.x, side, row);
    mix_row(before.data(), side, row);
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      const double coverage = geometry[cell].coverage;
      if (coverage <= 0.0) {
        cells[cell] = CellTraction{};
        continue;
      }
      const CarriedCell& carried = row.carried[i];
      const double share = 1.0 / std::max(carried.z, coverage);
      cells[cell].traction = share * (turn_x * carried.x + turn_y * carried.y);
      cells[cell].coverage = coverage;
      cells[cell].kinetic_share = carried.w;
    }
  }
}

/// As follow_grid, for a grid that has not moved.
void dilute(CellTraction& cell, double coverage) {
  if (coverage > cell.coverage) {
    cell.traction *= cell.coverage / coverage;
  }
  cell.coverage = coverage;
}

void carry(StepContext& context, std::uint32_t region) {
  const Model& model = context.model;
  State& state = context.state;
  const std::uint32_t side = model.settings.grid_side;
  const Range rows = state.regions.at<RegionIdentity>(region).cells;
  const auto cells = state.cells.rows<CellTraction>(rows);
  const RegionFrame& now = state.regions.at<RegionFrame>(region);
  RegionFrame& old = state.regions.at<TractionFrame>(region).frame;
  if (old.half_size.x <= 0.0) {
    old = now;
  }
  const CellMap map = map_of(old, now, side);
  if (farthest_move(map, side) >= kStill) {
    follow_grid(context, map, old, now, rows);
    old = now;
    return;
  }
  const auto geometry = state.cells.rows<CellGeometry>(rows);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    dilute(cells[cell], geometry[cell].coverage);
  }
}

}  // namespace

void PaperScratch::reserve(const Model& model) {
  const std::size_t side = model.settings.grid_side;
  carried_cells.assign((side + 2) * (side + 2), CarriedCell(0.0));
}

void carry_tractions(StepContext& context) {
  for (std::uint32_t region = 0; region < context.state.regions.size(); ++region) {
    const std::uint32_t body = context.state.regions.at<RegionIdentity>(region).body;
    if (context.model.bodies.at<BodyModels>(body).contact == ContactModel::kPaper) {
      carry(context, region);
    }
  }
}

}  // namespace torsion::engine
