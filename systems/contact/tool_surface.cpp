#include "systems/contact/tool_surface.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/grid_cells.hpp"
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

}  // namespace torsion::engine
