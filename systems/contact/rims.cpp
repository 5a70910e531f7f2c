#include "systems/contact/rims.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "systems/contact/tool_surface.hpp"
#include "systems/geometry/distance_shapes.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

// |cosine| between a surface's normal and the grid's. Below the first limit the surface is a side,
// above the second an underside.
constexpr double kSide = kSteepest;
constexpr double kUnderside = kFullyFacing;

// Squares of what the distance to the tool changes by along the normal: below the first an
// underside bends up to a side, below the second it is one. With 0.09 as the first, one more plate
// alternated of those that held_still_test.cpp holds still.
constexpr double kBendsUp = 1.0 / 9.0;
constexpr double kSideways = 1.05 * kSide * kSide;

constexpr double kWholly = 1.0 - 1e-9;  // of a share

/// Nothing of a tool is looked for above, m, grid.
double highest_place(const Grid& grid) {
  return 0.5 * std::max(grid.frame.half_size.x, grid.frame.half_size.y);
}

/// Finds how far cells have no underside: wholly where they have climbed to where nothing touches
/// or end on a side, in part where they end on what bends up to one. The rounded edges of a mesh do
/// that within a hundredth of a cell: with a limit instead a cell that is held there could change
/// between its two depths in every step.
/// @param open  0 to 1, out
TORSION_WIDEST
void find_open(std::size_t count, double highest, const double* __restrict z,
               const double* __restrict tool_x, const double* __restrict tool_y,
               const double* __restrict gradient_square, double* __restrict open) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double slope = tool_x[cell] * tool_x[cell] + tool_y[cell] * tool_y[cell];
    const double along = gradient_square[cell] / (1.0 + slope);
    const double side = smooth_step((kBendsUp - along) * (1.0 / (kBendsUp - kSideways)));
    open[cell] = z[cell] >= highest ? 1.0 : side;
  }
}

/// Distances from the listed cells' places, raised by `above`, to the tool.
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

/// Cells on plane sides stay as they are found until those are so steep that they have no
/// underside: along a plane side all cells would go over at once, and halfway carry less than at
/// either end. What bends up is steeper farther up.
/// @param above  m: how much farther
void keep_plane_sides(const Grid& grid, double above) {
  const CellColumns& columns = grid.scratch.cell_columns;
  std::size_t count = 0;
  for (std::uint32_t cell = 0; cell < columns.open.size(); ++cell) {
    if (columns.open[cell] > 0.0 && columns.open[cell] < 1.0) {
      grid.scratch.left_cells.cells[count++] = cell;
    }
  }
  if (count == 0) {
    return;
  }
  constexpr double kBentRatio = 0.7;
  constexpr double kPlane = 0.9;
  const DistanceColumns sides = distances_above(grid, count, above);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = grid.scratch.left_cells.cells[k];
    const double slope =
        columns.tool_x[cell] * columns.tool_x[cell] + columns.tool_y[cell] * columns.tool_y[cell];
    const double ratio =
        sides.gradient_z[k] * sides.gradient_z[k] * (1.0 + slope) / columns.gradient_square[cell];
    columns.open[cell] *= smooth_step((kPlane - ratio) / (kPlane - kBentRatio));
  }
}

/// The cells of which a value is above a limit.
CellBits bits_above(std::span<const double> values, std::uint32_t side, double limit) {
  CellBits bits{};
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      bits[j] |= static_cast<std::uint64_t>(values[std::size_t{j} * side + i] > limit) << i;
    }
  }
  return bits;
}

/// The tool's underside, extended to a cell beside the tool; sums over neighbours by how far they
/// have one.
struct Underside {
  double height = 0.0;  // m, grid
  double slope_x = 0.0;
  double slope_y = 0.0;
  double weight = 0.0;
  double even = 0.0;  // of the weight: of neighbours whose slopes can be extended
};

Underside operator+(const Underside& a, const Underside& b) {
  return {a.height + b.height, a.slope_x + b.slope_x, a.slope_y + b.slope_y, a.weight + b.weight,
          a.even + b.even};
}

Underside operator*(double factor, const Underside& of) {
  return {factor * of.height, factor * of.slope_x, factor * of.slope_y, factor * of.weight,
          factor * of.even};
}

/// How well a cell's underside can be extended that way: 1 up to 27 degrees, 0 from 45 degrees. Of
/// a face only its slope along the way counts. Between the faces of a mesh, whose distances are
/// rounded at its edges, the gradient is no normal, and all of its slope does.
/// @param way  of any length
double evenness(const CellColumns& columns, std::size_t cell, const glm::dvec2& way) {
  constexpr double kEven = 0.25;  // squares of slopes
  constexpr double kAskew = 1.0;
  const glm::dvec2 slope(columns.tool_x[cell], columns.tool_y[cell]);
  const double along = glm::dot(slope, way);
  const double along_square = along * along / std::max(glm::dot(way, way), 1e-300);
  const double sure = normal_share(columns.gradient_square[cell]);
  const double square = sure * along_square + (1.0 - sure) * glm::dot(slope, slope);
  return 1.0 - smooth_step((square - kEven) / (kAskew - kEven));
}

/// Extends the underside of the neighbours that have one to a cell: of the four beside it, or, as
/// far as they have none, of those at its corners. Sums are made in pairs, so that a mirror image
/// has the same bits.
Underside carried_on(const Grid& grid, CellPlace to) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const glm::dvec2 length = 2.0 * cell_half_size(grid);
  const auto from = [&](std::int32_t right, std::int32_t up) -> Underside {
    const std::uint32_t i = to.i + static_cast<std::uint32_t>(right);
    const std::uint32_t j = to.j + static_cast<std::uint32_t>(up);
    if (i >= grid.side || j >= grid.side) {
      return {};
    }
    const std::size_t cell = std::size_t{j} * grid.side + i;
    // Between two faces a gradient is no normal, and its slopes are neither face's.
    const double sure = normal_share(columns.gradient_square[cell]);
    const double slope_x = sure * columns.tool_x[cell];
    const double slope_y = sure * columns.tool_y[cell];
    return (1.0 - columns.open[cell]) *
           Underside{columns.points.z[cell] - right * length.x * slope_x - up * length.y * slope_y,
                     slope_x, slope_y, 1.0,
                     evenness(columns, cell, {right * length.x, up * length.y})};
  };
  Underside sum = (from(-1, 0) + from(1, 0)) + (from(0, -1) + from(0, 1));
  if (sum.weight < 1.0) {
    sum = sum + (1.0 - sum.weight) * ((from(-1, -1) + from(1, 1)) + (from(-1, 1) + from(1, -1)));
  }
  return sum.weight > 0.0 ? Underside{sum.height / sum.weight, sum.slope_x / sum.weight,
                                      sum.slope_y / sum.weight, sum.weight, sum.even}
                          : sum;
}

/// Lists the cells on both sides of the rims.
/// @return how many there are, in LeftCells::cells
std::size_t list_rims(const Grid& grid) {
  const std::span<const double> open = grid.scratch.cell_columns.open;
  const CellBits any_open = bits_above(open, grid.side, 0.0);
  const CellBits all_open = bits_above(open, grid.side, kWholly);
  const std::uint64_t all =
      grid.side < 64 ? (std::uint64_t{1} << grid.side) - 1 : ~std::uint64_t{0};
  CellBits closed{};
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    closed[j] = all & ~all_open[j];
  }
  CellBits free_open = any_open;
  CellBits free_closed = closed;
  CellBits around_closed = closed;
  CellBits around_open = any_open;
  spread_one_step(grid.side, free_open, around_closed);
  spread_one_step(grid.side, free_closed, around_open);
  std::size_t count = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t rim = around_closed[j] & around_open[j]; rim != 0; rim &= rim - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rim));
      grid.scratch.left_cells.cells[count++] = j * grid.side + i;
    }
  }
  return count;
}

/// Puts the listed cells that lack an underside on that of their neighbours.
/// @post  CellColumns::open: how far each is to be there, 0 to 1; LeftCells: the slopes of each
///        where it was found, and as gradient_square its height there, m
void extend_undersides(const Grid& grid, std::size_t count) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const LeftCells& left = grid.scratch.left_cells;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = left.cells[k];
    left.gradient_square[k] = columns.points.z[cell];
    const double sure = normal_share(columns.gradient_square[cell]);
    left.tool_x[k] = sure * columns.tool_x[cell];
    left.tool_y[k] = sure * columns.tool_y[cell];
    if (columns.open[cell] <= 0.0) {
      continue;
    }
    const Underside under = carried_on(grid, {cell % grid.side, cell / grid.side});
    // What has no underside at all has no place of its own.
    left.points.x[k] =
        columns.open[cell] > kWholly ? 1.0 : columns.open[cell] * std::min(under.even, 1.0);
    left.points.z[k] = under.height;
    left.points.gradient_x[k] = under.slope_x;
    left.points.gradient_y[k] = under.slope_y;
  }
  // Only now: until here cells are the neighbours of others.
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = left.cells[k];
    if (columns.open[cell] <= 0.0) {
      continue;
    }
    columns.open[cell] = left.points.x[k];
    if (columns.open[cell] > 0.0) {
      columns.points.z[cell] = left.points.z[k];
      columns.tool_x[cell] = left.points.gradient_x[k];
      columns.tool_y[cell] = left.points.gradient_y[k];
      columns.gradient_square[cell] = 1.0;
    }
  }
}

/// How far a cell lies at a rim, 0 to 1: as far as it is on its neighbours' underside, or, with an
/// underside of its own, as one of its neighbours is.
double part_at_rim(const Grid& grid, std::uint32_t cell) {
  const std::span<const double> open = grid.scratch.cell_columns.open;
  if (open[cell] > 0.0) {
    return open[cell];
  }
  const std::uint32_t i = cell % grid.side;
  const std::uint32_t j = cell / grid.side;
  const std::uint32_t last = grid.side - 1;
  double most = 0.0;
  for (std::uint32_t row = j - (j > 0 ? 1 : 0); row <= std::min(j + 1, last); ++row) {
    for (std::uint32_t at = i - (i > 0 ? 1 : 0); at <= std::min(i + 1, last); ++at) {
      most = std::max(most, open[std::size_t{row} * grid.side + at]);
    }
  }
  return most;
}

/// What of a cell lies under the tool.
struct RimCell {
  double share = 1.0;
  double bearing = 1.0;
  glm::dvec2 way{0.0};  // m: from its centre to the middle of that
};

/// Of a cell on an underside beside which the tool has a side.
/// @param side      unit: out of the tool's side, of which the grid's part counts
/// @param distance  m: from the cell's place to that
RimCell cell_at_side(const glm::dvec2& half, const glm::dvec3& side, double distance) {
  const double across = 2.0 * (std::abs(side.x) * half.x + std::abs(side.y) * half.y);
  const double aspect = across * across / (4.0 * half.x * half.y);
  const double share = share_below(-distance, across);
  const double inward = std::max(distance + 0.5 * share * across, 0.0);
  return {share, bearing_of(share_below(kRimBeyond * across - distance, across), aspect),
          -inward / (side.x * side.x + side.y * side.y) * glm::dvec2(side)};
}

/// Finds of the listed cells what lies under the tool, and puts them there as far as they lie at a
/// rim.
void cut_at_sides(const Grid& grid, std::size_t count, double above) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const glm::dvec2 half = cell_half_size(grid);
  const DistanceColumns sides = distances_above(grid, count, above);
  const LeftCells& found = grid.scratch.left_cells;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = found.cells[k];
    const glm::dvec3 side(sides.gradient_x[k], sides.gradient_y[k], sides.gradient_z[k]);
    const double part = part_at_rim(grid, cell);
    const double steep = smooth_step((kUnderside - std::abs(side.z)) / (kUnderside - kSide)) *
                         evenness(columns, cell, glm::dvec2(side));
    // Nothing of what has no underside lies under the tool, but for what a side leaves of it.
    const double otherwise = columns.open[cell] > 0.0 ? 0.0 : 1.0 - steep;
    RimCell rim{otherwise, otherwise};
    if (steep > 0.0) {
      rim = cell_at_side(half, side, sides.value[k] - side.z * above);
      rim = {steep * rim.share + otherwise, steep * rim.bearing + otherwise, steep * rim.way};
    }
    const double sure = part * normal_share(columns.gradient_square[cell]);
    const double rest = 1.0 - part;
    columns.rim_share[cell] = part * rim.share + rest;
    columns.rim_bearing[cell] = part * rim.bearing + rest;
    columns.points.x[cell] += part * rim.way.x;
    columns.points.y[cell] += part * rim.way.y;
    columns.points.z[cell] =
        rest * found.gradient_square[k] + part * columns.points.z[cell] +
        sure * (columns.tool_x[cell] * rim.way.x + columns.tool_y[cell] * rim.way.y);
    columns.tool_x[cell] = rest * found.tool_x[k] + sure * columns.tool_x[cell];
    columns.tool_y[cell] = rest * found.tool_y[k] + sure * columns.tool_y[cell];
  }
}

}  // namespace

bool find_rims(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  find_open(columns.open.size(), highest_place(grid), columns.points.z.data(),
            columns.tool_x.data(), columns.tool_y.data(), columns.gradient_square.data(),
            columns.open.data());
  const double above = glm::length(cell_half_size(grid));
  keep_plane_sides(grid, above);
  const std::size_t count = list_rims(grid);
  if (count == 0) {
    return false;
  }
  extend_undersides(grid, count);
  std::ranges::fill(columns.rim_share, 1.0);
  std::ranges::fill(columns.rim_bearing, 1.0);
  cut_at_sides(grid, count, above);
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
    // Chosen so that the mean over the covered part stays `mean`.
    change = coverage > 0.0 ? 2.0 * mean / coverage : change;
  }
}

double bearing_of(double share, double aspect) {
  return share / (share + std::cbrt(aspect) * (1.0 - share));
}

}  // namespace torsion::engine
