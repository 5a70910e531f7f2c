#include "systems/contact/rim_cells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/tool_surface.hpp"
#include "systems/geometry/gradient_length.hpp"
#include "systems/math/lanes.hpp"

namespace torsion {
namespace {

// |cosine| between a surface's normal and the grid's: a side below the one, an underside from the
// other.
constexpr double kSide = kSteepest;
constexpr double kUnderside = kFullyFacing;

/// Cells that have found no underside: they have gone up to where nothing touches, or end on a
/// side.
/// @param open  1 or 0, out
/// @return how many there are
TORSION_WIDEST
std::size_t find_open(std::size_t count, double highest, const double* __restrict z,
                      const double* __restrict tool_x, const double* __restrict tool_y,
                      double* __restrict open) {
  constexpr double kSteepSlope = 0.95 * (1.0 / (kSide * kSide) - 1.0);
  std::size_t sum = 0;  // no floating point number: its sum would be one cell after the other
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double slope = tool_x[cell] * tool_x[cell] + tool_y[cell] * tool_y[cell];
    const bool none = (z[cell] >= highest) | (slope > kSteepSlope);
    open[cell] = none ? 1.0 : 0.0;
    sum += none ? 1 : 0;
  }
  return sum;
}

CellBits bits_of(const double* values, std::uint32_t side) {
  CellBits bits{};
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      bits[j] |= static_cast<std::uint64_t>(values[std::size_t{j} * side + i] != 0.0) << i;
    }
  }
  return bits;
}

/// What a cell beside the tool would have of its underside.
struct Underside {
  double height = 0.0;  // m, grid
  double slope_x = 0.0;
  double slope_y = 0.0;
  double count = 0.0;
};

Underside operator+(const Underside& a, const Underside& b) {
  return {a.height + b.height, a.slope_x + b.slope_x, a.slope_y + b.slope_y, a.count + b.count};
}

/// The underside of the neighbours that have one, carried on to a cell: of those beside it, or else
/// those across its corners. Sums in pairs, so that a mirror image has the same bits.
Underside carried_on(const Grid& grid, const CellBits& closed, std::uint32_t i, std::uint32_t j) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const glm::dvec2 length = 2.0 * cell_half_size(grid);
  const auto from = [&](std::int32_t right, std::int32_t up) -> Underside {
    const std::uint32_t at_i = i + static_cast<std::uint32_t>(right);
    const std::uint32_t at_j = j + static_cast<std::uint32_t>(up);
    if (at_i >= grid.side || at_j >= grid.side || (closed[at_j] >> at_i & 1U) == 0) {
      return {};
    }
    const std::size_t cell = std::size_t{at_j} * grid.side + at_i;
    const double sure = normal_share(columns.gradient_square[cell]);
    const double slope_x = sure * columns.tool_x[cell];
    const double slope_y = sure * columns.tool_y[cell];
    return {columns.points.z[cell] - right * length.x * slope_x - up * length.y * slope_y, slope_x,
            slope_y, 1.0};
  };
  Underside sum = (from(-1, 0) + from(1, 0)) + (from(0, -1) + from(0, 1));
  if (sum.count == 0.0) {
    sum = (from(-1, -1) + from(1, 1)) + (from(-1, 1) + from(1, -1));
  }
  return {sum.height / sum.count, sum.slope_x / sum.count, sum.slope_y / sum.count, sum.count};
}

/// Lists the cells on both sides of the rims and puts those beside the tool on its underside.
/// @return how many there are, in LeftCells::cells
std::size_t list_rims(const Grid& grid, const CellBits& open) {
  const CellColumns& columns = grid.scratch.cell_columns;
  CellBits closed{};
  const std::uint64_t all =
      grid.side < 64 ? (std::uint64_t{1} << grid.side) - 1 : ~std::uint64_t{0};
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    closed[j] = all & ~open[j];
  }
  CellBits free_open = open;
  CellBits free_closed = closed;
  CellBits around_closed = closed;
  CellBits around_open = open;
  spread_one_step(grid.side, free_open, around_closed);
  spread_one_step(grid.side, free_closed, around_open);
  std::size_t count = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t rim = around_closed[j] & around_open[j]; rim != 0; rim &= rim - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rim));
      const std::uint32_t cell = j * grid.side + i;
      grid.scratch.left_cells.cells[count++] = cell;
      if ((open[j] >> i & 1U) != 0) {
        const Underside under = carried_on(grid, closed, i, j);
        columns.points.z[cell] = under.height;
        columns.tool_x[cell] = under.slope_x;
        columns.tool_y[cell] = under.slope_y;
        columns.gradient_square[cell] = 1.0;
      }
    }
  }
  return count;
}

/// The share of a cell on the tool's side of a plane.
/// @param distance  m: of the cell's centre, outside
/// @param across    m: how far the cell reaches along the plane's normal
double share_inside(double distance, double across) {
  return std::clamp(0.5 - distance / across, 0.0, 1.0);
}

/// How well an underside with such slopes can be carried on past its rim: 1 up to 27 degrees, 0
/// from 45 degrees, as between the faces of a mesh, whose distances are rounded at its edges.
double evenness(double slope_x, double slope_y) {
  constexpr double kEven = 0.25;  // squares of slopes
  constexpr double kAskew = 1.0;
  const double slope = slope_x * slope_x + slope_y * slope_y;
  return 1.0 - smooth_step((slope - kEven) / (kAskew - kEven));
}

/// The distances of the listed cells' places, `above` higher, to the tool.
DistanceColumns distances_above(const Grid& grid, std::size_t count, double above) {
  const DistanceColumns& from = grid.scratch.cell_columns.points;
  const LeftCells& left = grid.scratch.left_cells;
  const DistanceColumns& all = left.points;
  const DistanceColumns points{all.x.first(count),          all.y.first(count),
                               all.z.first(count),          all.value.first(count),
                               all.gradient_x.first(count), all.gradient_y.first(count),
                               all.gradient_z.first(count)};
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = left.cells[k];
    points.x[k] = from.x[cell];
    points.y[k] = from.y[cell];
    points.z[k] = from.z[cell] + above;
  }
  const Pose frame = grid_in_tool(grid);
  const auto parts =
      parts_under(grid, grid.model.tools.at<OwnedRows>(grid.identity.tool).parts, frame.position);
  signed_distances(grid.model, parts, frame, points);
  return points;
}

/// Moves a cell's place on the underside into the middle of what of the cell lies under it: beside
/// a rim of a face that is tilted the overlap is another one than there.
/// @param side    unit: out of the tool's side, of which the grid's part counts
/// @param inward  m: along that
void move_inward(const CellColumns& columns, std::size_t cell, const glm::dvec3& side,
                 double inward) {
  const glm::dvec2 way = -inward / (side.x * side.x + side.y * side.y) * glm::dvec2(side);
  columns.points.x[cell] += way.x;
  columns.points.y[cell] += way.y;
  columns.points.z[cell] += normal_share(columns.gradient_square[cell]) *
                            (columns.tool_x[cell] * way.x + columns.tool_y[cell] * way.y);
}

}  // namespace

bool find_rims(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const std::span<double> shares = columns.rim_share;
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  const std::size_t any = find_open(shares.size(), 0.5 * size, columns.points.z.data(),
                                    columns.tool_x.data(), columns.tool_y.data(), shares.data());
  if (any == 0 || any == shares.size()) {
    return false;
  }
  const CellBits open = bits_of(shares.data(), grid.side);
  const std::size_t count = list_rims(grid, open);
  const glm::dvec2 half = cell_half_size(grid);
  const double above = glm::length(half);
  const DistanceColumns found = distances_above(grid, count, above);
  std::ranges::fill(shares, 1.0);
  std::ranges::fill(columns.rim_bearing, 1.0);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = grid.scratch.left_cells.cells[k];
    const double across =
        2.0 * (std::abs(found.gradient_x[k]) * half.x + std::abs(found.gradient_y[k]) * half.y);
    const double distance = found.value[k] - found.gradient_z[k] * above;
    const double steep =
        smooth_step((kUnderside - std::abs(found.gradient_z[k])) / (kUnderside - kSide)) *
        evenness(columns.tool_x[cell], columns.tool_y[cell]);
    const bool beside = (open[cell / grid.side] >> (cell % grid.side) & 1U) != 0;
    const double otherwise = beside ? 0.0 : 1.0 - steep;
    if (steep > 0.0) {
      const double aspect = across * across / (4.0 * half.x * half.y);
      const double share = share_inside(distance, across);
      shares[cell] = steep * share + otherwise;
      move_inward(columns, cell, {found.gradient_x[k], found.gradient_y[k], found.gradient_z[k]},
                  steep * std::max(distance + 0.5 * share * across, 0.0));
      columns.rim_bearing[cell] =
          steep * bearing_of(share_inside(distance - kRimBeyond * across, across), aspect) +
          otherwise;
    } else {
      shares[cell] = columns.rim_bearing[cell] = otherwise;
    }
  }
  return true;
}

void take_rims(const CellColumns& columns) {
  for (std::size_t cell = 0; cell < columns.coverage.size(); ++cell) {
    const double share = columns.rim_share[cell];
    double& coverage = columns.coverage[cell];
    columns.bearing[cell] *= columns.rim_bearing[cell];
    if (share >= 1.0 || coverage <= 0.0) {
      continue;
    }
    double& change = columns.depth_change[cell];
    const double mean = coverage < 1.0 ? 0.5 * coverage * change : columns.depth[cell];
    coverage *= share;
    // What makes the mean over the covered part be `mean` still.
    change = coverage > 0.0 ? 2.0 * mean / coverage : change;
  }
}

double bearing_of(double share, double aspect) {
  return share / (share + std::cbrt(aspect) * (1.0 - share));
}

}  // namespace torsion
