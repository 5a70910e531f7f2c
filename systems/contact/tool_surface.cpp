#include "systems/contact/tool_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/geometry/distance_shapes.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

constexpr int kMostSurfaceSteps = 10;  // of Newton's method down to the tool's surface
constexpr double kCloseEnough =
    0.02;                         // of a cell: where no cell steps farther, the step is the last
constexpr double kAtRest = 1e-6;  // of a cell: one that steps less is left where it is

/// Copies the cells' places of the last step into columns, in the grid's frame.
void place_centers(const Grid& grid) {
  const DistanceColumns& points = grid.scratch.cell_columns.points;
  cell_centers(grid.frame, grid.side, points.x, points.y);
  double* const z = points.z.data();
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    z[cell] = grid.cells[cell].height;
  }
}

/// The largest of sign * values and 0; NaN counts as 0.
TORSION_WIDEST
void find_largest(const double* __restrict values, std::size_t count, double sign,
                  Lanes& __restrict lanes) {
  Lanes most{};
  for (std::size_t first = 0; first < count; first += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      most[lane] = larger(sign * values[first + lane], most[lane]);
    }
  }
  lanes = most;
}

double extreme_of(std::span<const double> column, double sign) {
  Lanes lanes;
  find_largest(column.data(), column.size(), sign, lanes);
  return largest_of(lanes);
}

/// How far the cells' places are below the grid's plane, m.
double deepest_place(const Grid& grid) {
  return extreme_of(grid.scratch.cell_columns.points.z, -1.0);
}

/// Cells that found nothing of the tool near the rest surface start again from below: their present
/// place may be above the tool, from where Newton's method does not find the underside.
void return_from_above(const Grid& grid) {
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  const double lowest = -deepest_place(grid);
  const std::span<double> z = grid.scratch.cell_columns.points.z;
  for (double& height : z) {
    height = height < 0.5 * size ? height : lowest;
  }
}

/// One step of Newton's method along the normal from every cell to the tool's underside, and the
/// slopes of that.
/// @param value  m: in: distance to the tool; out: by how much the height changes
TORSION_WIDEST
void step_to_surface(double size, std::size_t count, const double* __restrict gradient_x,
                     const double* __restrict gradient_y, const double* __restrict gradient_z,
                     double* __restrict value, double* __restrict z, double* __restrict tool_x,
                     double* __restrict tool_y, double* __restrict gradient_square) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double over_slope = 1.0 / larger(-gradient_z[cell], kSteepest);
    const double change = value[cell] * over_slope;
    const double from = z[cell];
    const double height = from + change;
    // Above the rest surface there is no contact, however far away the tool is.
    const double to = height < size ? height : size;
    z[cell] = to;
    // A cell that stays there counts as converged, though it is not on the tool.
    value[cell] = to < size ? std::abs(change) : to - from;
    tool_x[cell] = gradient_x[cell] * over_slope;
    tool_y[cell] = gradient_y[cell] * over_slope;
    gradient_square[cell] = gradient_x[cell] * gradient_x[cell] +
                            gradient_y[cell] * gradient_y[cell] +
                            gradient_z[cell] * gradient_z[cell];
  }
}

void step_to_surface(double size, const DistanceColumns& points, std::span<double> tool_x,
                     std::span<double> tool_y, std::span<double> gradient_square) {
  step_to_surface(size, points.x.size(), points.gradient_x.data(), points.gradient_y.data(),
                  points.gradient_z.data(), points.value.data(), points.z.data(), tool_x.data(),
                  tool_y.data(), gradient_square.data());
}

/// The first of the cells that are left.
LeftCells first_of(const LeftCells& left, std::size_t count) {
  const DistanceColumns& points = left.points;
  return {left.cells.first(count),
          {points.x.first(count), points.y.first(count), points.z.first(count),
           points.value.first(count), points.gradient_x.first(count),
           points.gradient_y.first(count), points.gradient_z.first(count)},
          left.tool_x.first(count),
          left.tool_y.first(count),
          left.gradient_square.first(count)};
}

/// Whether a cell that may be in contact, because its underside with its slopes comes below the
/// rest surface, still moves far.
/// @param cell_length  m
/// @param moved, z, tool_x, tool_y  (n) of the cells
bool any_moves_far(double cell_length, std::span<const double> moved, std::span<const double> z,
                   std::span<const double> tool_x, std::span<const double> tool_y) {
  bool far = false;
  for (std::size_t k = 0; k < moved.size(); ++k) {
    far = far || (moved[k] >= kCloseEnough * cell_length &&
                  z[k] < cell_length * (std::abs(tool_x[k]) + std::abs(tool_y[k])));
  }
  return far;
}

/// Lists the cells that have not converged.
/// @param moved  m, (n) of the cells `of`, all when that is empty
LeftCells cells_left(const LeftCells& memory, double cell_length, std::span<const double> moved,
                     std::span<const std::uint32_t> of) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < moved.size(); ++k) {
    if (moved[k] >= kAtRest * cell_length) {
      memory.cells[count++] = of.empty() ? static_cast<std::uint32_t>(k) : of[k];
    }
  }
  return first_of(memory, count);
}

/// Raises cells that still climb beside or above the tool to the height where nothing touches:
/// there is no underside above them, and their slopes belong to none.
/// @param points  (n) of the cells `of`, all when that is empty; value: how far they have moved, m
void raise_climbing(const CellColumns& columns, const DistanceColumns& points, double cell_length,
                    double size, std::span<const std::uint32_t> of) {
  for (std::size_t k = 0; k < points.value.size(); ++k) {
    if (points.value[k] >= kCloseEnough * cell_length && points.gradient_z[k] > -kSteepest) {
      columns.points.z[of.empty() ? k : of[k]] = size;
    }
  }
}

/// One step for the cells that have not converged.
void step_left_cells(const Grid& grid, std::span<const std::uint32_t> parts, const Pose& frame,
                     double size, const LeftCells& left) {
  const CellColumns& columns = grid.scratch.cell_columns;
  for (std::size_t k = 0; k < left.cells.size(); ++k) {
    const std::uint32_t cell = left.cells[k];
    left.points.x[k] = columns.points.x[cell];
    left.points.y[k] = columns.points.y[cell];
    left.points.z[k] = columns.points.z[cell];
  }
  signed_distances(grid.model, parts, frame, left.points);
  step_to_surface(size, left.points, left.tool_x, left.tool_y, left.gradient_square);
  for (std::size_t k = 0; k < left.cells.size(); ++k) {
    const std::uint32_t cell = left.cells[k];
    columns.points.z[cell] = left.points.z[k];
    columns.tool_x[cell] = left.tool_x[k];
    columns.tool_y[cell] = left.tool_y[k];
    columns.gradient_square[cell] = left.gradient_square[k];
  }
}

}  // namespace

std::span<const std::uint32_t> parts_under(const Grid& grid, Range parts,
                                           const glm::dvec3& origin) {
  // There is only one to choose.
  const double reach =
      parts.count > 1 ? glm::length(grid.frame.half_size) + deepest_place(grid) : 0.0;
  return parts_near(grid.model, parts, origin, reach, grid.scratch.near_parts);
}

void find_tool_surface(const Grid& grid) {
  place_centers(grid);
  return_from_above(grid);
  const CellColumns& columns = grid.scratch.cell_columns;
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  const double cell_length = size / static_cast<double>(grid.side);
  const Pose frame = grid_in_tool(grid);
  const auto parts =
      parts_under(grid, grid.model.tools.at<OwnedRows>(grid.identity.tool).parts, frame.position);
  signed_distances(grid.model, parts, frame, columns.points);
  step_to_surface(size, columns.points, columns.tool_x, columns.tool_y, columns.gradient_square);
  if (extreme_of(columns.points.value, 1.0) < kCloseEnough * cell_length) {
    return;
  }
  if (!any_moves_far(cell_length, columns.points.value, columns.points.z, columns.tool_x,
                     columns.tool_y)) {
    raise_climbing(columns, columns.points, cell_length, size, {});
    return;
  }
  const LeftCells& memory = grid.scratch.left_cells;
  LeftCells left = cells_left(memory, cell_length, columns.points.value, {});
  for (int step = 1; step < kMostSurfaceSteps; ++step) {
    step_left_cells(grid, parts, frame, size, left);
    if (step + 1 == kMostSurfaceSteps ||
        !any_moves_far(cell_length, left.points.value, left.points.z, left.tool_x, left.tool_y)) {
      raise_climbing(columns, left.points, cell_length, size, left.cells);
      return;
    }
    left = cells_left(memory, cell_length, left.points.value, left.cells);
  }
}

namespace {

// |cosine| between a surface's normal and the grid's. Below the first limit the surface is a side,
// above the second an underside.
constexpr double kSide = kSteepest;
constexpr double kUnderside = kFullyFacing;

/// Finds the cells without an underside: they have climbed to where nothing touches, or end on a
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

/// The tool's underside, extended to a cell beside the tool.
struct Underside {
  double height = 0.0;  // m, grid
  double slope_x = 0.0;
  double slope_y = 0.0;
  double count = 0.0;
};

Underside operator+(const Underside& a, const Underside& b) {
  return {a.height + b.height, a.slope_x + b.slope_x, a.slope_y + b.slope_y, a.count + b.count};
}

/// Extends the underside of the neighbours that have one to a cell: of the four beside it, or else
/// of those at its corners. Sums are made in pairs, so that a mirror image has the same bits.
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

/// Lists the cells on both sides of the rims and extends the underside to those beside the tool.
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

/// How well an underside with such slopes can be extended past its rim: 1 up to 27 degrees, 0 from
/// 45 degrees (as between the faces of a mesh, whose distances are rounded at its edges).
double evenness(double slope_x, double slope_y) {
  constexpr double kEven = 0.25;  // squares of slopes
  constexpr double kAskew = 1.0;
  const double slope = slope_x * slope_x + slope_y * slope_y;
  return 1.0 - smooth_step((slope - kEven) / (kAskew - kEven));
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

/// Moves a cell's place on the underside to the middle of the part of the cell that lies under it:
/// beside a rim of a tilted face the overlap is different there.
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
    // Chosen so that the mean over the covered part stays `mean`.
    change = coverage > 0.0 ? 2.0 * mean / coverage : change;
  }
}

double bearing_of(double share, double aspect) {
  return share / (share + std::cbrt(aspect) * (1.0 - share));
}

}  // namespace torsion::engine
