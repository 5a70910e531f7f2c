#include "systems/contact/body_edges.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact/tool_surface.hpp"

namespace torsion::engine {
namespace {

/// Lists the cells inside the body under a face that lies askew, in ContactScratch::left_cells, at
/// the places where that face is over them.
std::size_t list_askew(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const LeftCells& left = grid.scratch.left_cells;
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < columns.coverage.size(); ++cell) {
    const double slope = columns.points.gradient_z[cell];
    if (columns.points.value[cell] < 0.0 && slope > kSteepest && askew_share(slope) > 0.0) {
      left.cells[count] = static_cast<std::uint32_t>(cell);
      left.points.x[count] = columns.points.x[cell];
      left.points.y[count] = columns.points.y[cell];
      left.points.z[count] = columns.points.z[cell] - columns.points.value[cell] / slope;
      ++count;
    }
  }
  return count;
}

/// The face that the tool presses on, as the mean of what of it is inside the tool; where there is
/// none, the grid's plane.
FacePlane pressed_plane(const CellColumns& columns) {
  double weight = 0.0;
  FacePlane sum;
  for (std::size_t cell = 0; cell < columns.coverage.size(); ++cell) {
    const double share = columns.coverage[cell];
    const double normal_z = columns.points.gradient_z[cell];
    if (share < 0.5 || normal_z < kFullyFacing) {
      continue;
    }
    const double slope_x = -columns.points.gradient_x[cell] / normal_z;
    const double slope_y = -columns.points.gradient_y[cell] / normal_z;
    weight += share;
    sum.slope_x += share * slope_x;
    sum.slope_y += share * slope_y;
    sum.at_origin += share * (columns.points.z[cell] + columns.depth[cell] -
                              slope_x * columns.points.x[cell] - slope_y * columns.points.y[cell]);
  }
  return weight > 0.0
             ? FacePlane{sum.at_origin / weight, sum.slope_x / weight, sum.slope_y / weight}
             : FacePlane{};
}

/// Of a cell in contact counts, beside an edge, what lies under the pressed face's plane.
/// @param deep    m: of the cell's place on the tool, under that
/// @param facing  facing_share of its nearest face
void cover_under(const FacePlane& plane, const Grid& grid, std::size_t cell, double deep,
                 double facing) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const glm::dvec2 half = cell_half_size(grid);
  const double across = 2.0 * (std::abs(columns.tool_x[cell] - plane.slope_x) * half.x +
                               std::abs(columns.tool_y[cell] - plane.slope_y) * half.y) +
                        1e-30;
  const double below = share_below(deep, across);
  const double mean = below < 1.0 ? 0.5 * below * across : deep;
  double& coverage = columns.coverage[cell];
  columns.depth[cell] = std::lerp(deep, columns.depth[cell], facing);
  coverage *= std::lerp(below, 1.0, facing);
  columns.bearing[cell] = coverage >= 0.5 ? 1.0 : 0.0;
  if (coverage > 0.0) {
    // Chosen so that the mean over the covered part of a partly covered cell is `mean`.
    columns.depth_change[cell] =
        facing * columns.depth_change[cell] + (1.0 - facing) * 2.0 * mean / coverage;
  }
}

}  // namespace

bool find_upper_faces(const Grid& grid) {
  const std::size_t count = list_askew(grid);
  if (count == 0) {
    return false;
  }
  const CellColumns& columns = grid.scratch.cell_columns;
  const LeftCells left = first_of(grid.scratch.left_cells, count);
  const auto parts = parts_under(grid, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts,
                                 grid.frame.origin);
  signed_distances(grid.model, parts, grid_in_body(grid.frame), left.points);
  const DistanceColumns& nearest = columns.points;
  const DistanceColumns& upper = left.points;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t cell = left.cells[k];
    const double slope = nearest.gradient_z[cell];
    const double part = askew_share(slope) * facing_share(upper.gradient_z[k]);
    const double deep = -nearest.value[cell] / slope -
                        part * upper.value[k] / std::max(upper.gradient_z[k], kSteepest);
    nearest.gradient_x[cell] = std::lerp(nearest.gradient_x[cell], upper.gradient_x[k], part);
    nearest.gradient_y[cell] = std::lerp(nearest.gradient_y[cell], upper.gradient_y[k], part);
    nearest.gradient_z[cell] = std::lerp(slope, upper.gradient_z[k], part);
    nearest.value[cell] = -deep * nearest.gradient_z[cell];
  }
  return true;
}

void cut_at_body_edges(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const FacePlane plane = pressed_plane(columns);
  grid.scratch.body_edges.face = plane;
  for (std::size_t cell = 0; cell < columns.coverage.size(); ++cell) {
    const double facing = facing_share(columns.points.gradient_z[cell]);
    const double own = facing * facing * facing * facing;
    const double deep =
        plane.height(columns.points.x[cell], columns.points.y[cell]) - columns.points.z[cell];
    columns.over_body[cell] = std::lerp(columns.coverage[cell], 1.0, own);
    columns.under_face[cell] = std::lerp(deep, columns.depth[cell], own);
    if (facing < 1.0 && columns.coverage[cell] > 0.0) {
      cover_under(plane, grid, cell, deep, facing);
    }
  }
}

}  // namespace torsion::engine
