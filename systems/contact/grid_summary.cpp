#include "systems/contact/grid_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/geometry/gradient_length.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"

namespace torsion {
namespace {

/// Sums over a grid's cells in contact, every eighth one after another.
struct alignas(64) GeometryLanes {
  Lanes area{}, volume{}, depth{}, x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{};
};

/// Reads columns up to a multiple of 8 cells, as Scratch lays them.
/// @param cell_area  m^2
TORSION_WIDEST
void add_up(const CellColumns& columns, double cell_area, std::size_t count,
            GeometryLanes& __restrict lanes) {
  const double* coverage = columns.coverage.data();
  const double* depth = columns.depth.data();
  const double* depth_change = columns.depth_change.data();
  const double* x = columns.points.x.data();
  const double* y = columns.points.y.data();
  const double* z = columns.points.z.data();
  const double* normal_x = columns.points.gradient_x.data();
  const double* normal_y = columns.points.gradient_y.data();
  const double* normal_z = columns.points.gradient_z.data();
  const std::size_t width = lanes.area.size();
  for (std::size_t first = 0; first < count; first += width) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      const std::size_t cell = first + lane;
      const double shared = coverage[cell];
      const double deep = depth[cell];
      const double height = z[cell];
      const double slope_x = normal_x[cell];
      const double slope_y = normal_y[cell];
      const double slope_z = normal_z[cell];
      const bool covered = shared > 0.0;
      const double share = covered ? shared * cell_area : 0.0;
      // Overlap per covered area: where the edge runs through a cell, depth rises linearly from it.
      const double at_edge = 0.5 * shared * depth_change[cell];
      const double volume = share * (shared < 1.0 ? at_edge : deep);
      // Of cells whose centre is over the body, and of the face that is pressed.
      const double length_squared = slope_x * slope_x + slope_y * slope_y + slope_z * slope_z;
      const double sure = normal_share(length_squared);
      const double counted =
          larger(2.0 * shared - 1.0, 0.0) * cell_area * facing_share(slope_z) * sure;
      lanes.area[lane] += share;
      lanes.volume[lane] += covered ? volume : 0.0;
      lanes.depth[lane] = larger(covered ? deep : 0.0, lanes.depth[lane]);
      lanes.x[lane] += share * x[cell];
      lanes.y[lane] += share * y[cell];
      lanes.z[lane] += covered ? share * height : 0.0;
      lanes.normal_x[lane] += covered ? counted * slope_x : 0.0;
      lanes.normal_y[lane] += covered ? counted * slope_y : 0.0;
      lanes.normal_z[lane] += covered ? counted * slope_z : 0.0;
    }
  }
}

}  // namespace

Overlap summarize_cells(const Grid& grid) {
  GeometryLanes lanes;
  add_up(grid.scratch.cell_columns, cell_area(grid.frame, grid.side), grid.cells.size(), lanes);
  Overlap overlap;
  overlap.center = grid.frame.origin;
  overlap.rest_center = grid.frame.origin;
  overlap.mean_normal = grid.frame.normal;
  overlap.area = sum_of(lanes.area);
  overlap.largest_depth = *std::ranges::max_element(lanes.depth);
  if (overlap.area <= 0.0) {
    return overlap;
  }
  const glm::dvec3 first_moment(sum_of(lanes.x), sum_of(lanes.y), sum_of(lanes.z));
  overlap.center = grid_to_body(grid.frame, first_moment / overlap.area);
  overlap.mean_depth = sum_of(lanes.volume) / overlap.area;
  overlap.rest_center = overlap.center + grid.frame.normal * overlap.mean_depth;
  overlap.radius = std::sqrt(overlap.area / std::numbers::pi);
  const glm::dvec3 normal(sum_of(lanes.normal_x), sum_of(lanes.normal_y), sum_of(lanes.normal_z));
  if (glm::length(normal) > 0.1 * overlap.area) {
    overlap.mean_normal = glm::normalize(tangent_to_body(grid.frame, glm::dvec2(normal)) +
                                         grid.frame.normal * normal.z);
  }
  return overlap;
}

}  // namespace torsion
