#include "systems/grid_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "systems/distance_shapes.hpp"
#include "systems/frames.hpp"
#include "systems/patch_grid.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

constexpr int kMostSurfaceSteps = 10;  // of Newton's method down to the tool's surface
constexpr double kSteepest =
    0.25;  // smallest |cosine| between a surface's normal and the grid's that is divided by

/// Where the material under the grid has gone, in the frame of its body.
Pose moved_grid_in_body(const Grid& grid) {
  const RegionCarrier& carrier = grid.carrier;
  Pose moved = grid_in_body(grid.frame);
  const double angle = glm::length(carrier.rotation);
  if (angle > 0.0) {
    moved.rotation = glm::angleAxis(angle, carrier.rotation / angle) * moved.rotation;
  }
  moved.position += carrier.translation;
  const RegionSupport& support = grid.support;
  const double turn = glm::length(support.rotation);
  if (turn > 0.0) {
    const glm::dquat rotation = glm::angleAxis(turn, support.rotation / turn);
    moved.rotation = rotation * moved.rotation;
    moved.position = support.about + rotation * (moved.position - support.about);
  }
  moved.position += support.translation;
  return moved;
}

/// The cells' centres as columns of points, in the grid's frame.
void place_centers(const Grid& grid) {
  const DistanceColumns& points = grid.scratch.cell_columns.points;
  for (std::uint32_t i = 0; i < grid.side; ++i) {
    const glm::dvec2 diagonal = cell_center(grid.frame, grid.side, i, i);
    for (std::uint32_t j = 0; j < grid.side; ++j) {
      points.x[std::size_t{j} * grid.side + i] = diagonal.x;
      points.y[std::size_t{i} * grid.side + j] = diagonal.y;
    }
  }
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    points.z[cell] = grid.cells[cell].height;
  }
}

/// The largest of sign * values and 0; NaN counts as 0. Several at a time, as one at a time would
/// wait for the one before.
TORSION_WIDEST
double largest(const double* values, std::size_t count, double sign) {
  constexpr std::size_t kLanes = 16;
  std::array<double, kLanes> lanes{};
  std::size_t first = 0;
  for (; first + kLanes <= count; first += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      lanes[lane] = larger(sign * values[first + lane], lanes[lane]);
    }
  }
  for (; first < count; ++first) {
    lanes[0] = larger(sign * values[first], lanes[0]);
  }
  double most = 0.0;
  for (const double lane : lanes) {
    most = larger(lane, most);
  }
  return most;
}

/// How far the cells' places are below the grid's plane, m.
double deepest_place(const Grid& grid) {
  const auto z = grid.scratch.cell_columns.points.z;
  return largest(z.data(), z.size(), -1.0);
}

/// Radius about the grid's origin that holds what of a surface can lie under the cells' centres and
/// below the rest surface.
double reach_of(const Grid& grid) {
  return glm::length(grid.frame.half_size) + deepest_place(grid);
}

/// Cells that found nothing of the tool near the rest surface look again from below: where they are
/// now may be above the tool, and from there no step leads to its underside.
void return_from_above(const Grid& grid) {
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  const double lowest = -deepest_place(grid);
  for (double& height : grid.scratch.cell_columns.points.z) {
    height = height < 0.5 * size ? height : lowest;
  }
}

/// One step of Newton's method along the normal from every cell to the tool's underside.
/// @return the largest change of a height below the rest surface, m
TORSION_WIDEST
double step_to_surface(const DistanceColumns& points, double size) {
  const std::size_t count = points.z.size();
  const double* __restrict normal = points.gradient_z.data();
  double* __restrict value = points.value.data();
  double* __restrict z = points.z.data();
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double change = value[cell] / larger(-normal[cell], kSteepest);
    const double height = z[cell] + change;
    // Above the rest surface there is no contact, however far away the tool is.
    z[cell] = height < size ? height : size;
    value[cell] = height < 0.0 ? std::abs(change) : 0.0;
  }
  return largest(value, count, 1.0);
}

/// Puts the cells' heights on the tool's underside. Leaves the tool's normals of the last step but
/// one in the columns.
void find_tool_surface(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  const Pose frame = grid_in_tool(grid);
  const auto parts =
      parts_near(grid.world, grid.world.tools.at<OwnedRows>(grid.identity.tool).parts,
                 frame.position, reach_of(grid), grid.scratch.near_parts);
  const double close_enough = 0.02 * size / static_cast<double>(grid.side);
  for (int step = 0; step < kMostSurfaceSteps; ++step) {
    signed_distances(grid.world, parts, frame, columns.points);
    if (step_to_surface(columns.points, size) < close_enough) {
      break;
    }
  }
  std::ranges::copy(columns.points.gradient_x, columns.tool_x.begin());
  std::ranges::copy(columns.points.gradient_y, columns.tool_y.begin());
  std::ranges::copy(columns.points.gradient_z, columns.tool_z.begin());
}

/// Depth under the body's rest surface, from the surface's first-order shape there.
TORSION_WIDEST
void find_depths(const DistanceColumns& points, std::size_t count, double* __restrict depth) {
  const double* value = points.value.data();
  const double* body_z = points.gradient_z.data();
  for (std::size_t cell = 0; cell < count; ++cell) {
    depth[cell] = -value[cell] / larger(body_z[cell], kSteepest);
  }
}

/// How much the depth changes across a cell, from both surfaces' first-order shape there.
/// @param half  m: half a cell
TORSION_WIDEST
void find_depth_changes(const CellColumns& columns, const glm::dvec2& half, std::size_t count,
                        double* __restrict depth_change) {
  const double half_x = half.x;
  const double half_y = half.y;
  const double* body_x = columns.points.gradient_x.data();
  const double* body_y = columns.points.gradient_y.data();
  const double* body_z = columns.points.gradient_z.data();
  const double* tool_x = columns.tool_x.data();
  const double* tool_y = columns.tool_y.data();
  const double* tool_z = columns.tool_z.data();
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double over_body_slope = 1.0 / larger(body_z[cell], kSteepest);
    const double over_tool_slope = 1.0 / larger(-tool_z[cell], kSteepest);
    const double change_x = tool_x[cell] * over_tool_slope + body_x[cell] * over_body_slope;
    const double change_y = tool_y[cell] * over_tool_slope + body_y[cell] * over_body_slope;
    depth_change[cell] = 2.0 * (std::abs(change_x) * half_x + std::abs(change_y) * half_y) + 1e-30;
  }
}

/// Distance of the cells' places on the tool to the body's rest surface.
void find_rest_surface(const Grid& grid) {
  const auto parts =
      parts_near(grid.world, grid.world.bodies.at<OwnedRows>(grid.identity.body).parts,
                 grid.frame.origin, reach_of(grid), grid.scratch.near_parts);
  signed_distances(grid.world, parts, grid_in_body(grid.frame), grid.scratch.cell_columns.points);
}

/// The share of a cell with depth > 0, to first order.
/// @param across  m: how much the depth changes across the cell
double share_below(double depth, double across) {
  return 2.0 * std::abs(depth) >= across ? (depth > 0.0 ? 1.0 : 0.0) : 0.5 + depth / across;
}

/// Beside an edge of the body its side is nearest: that says how much of the cell is over the body,
/// but the depth is the one under the face that the tool presses on, here its tangent plane.
void take_depth_from_plane(const Grid& grid, std::size_t cell, double facing) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const glm::dvec2 half = cell_half_size(grid);
  const double over_slope = 1.0 / larger(-columns.tool_z[cell], kSteepest);
  const double across =
      2.0 * over_slope *
          (std::abs(columns.tool_x[cell]) * half.x + std::abs(columns.tool_y[cell]) * half.y) +
      1e-30;
  const double height = columns.points.z[cell];
  const double below = share_below(-height, across);
  const double mean = below < 1.0 ? 0.5 * below * across : -height;
  double& coverage = columns.coverage[cell];
  columns.depth[cell] = facing * columns.depth[cell] - (1.0 - facing) * height;
  coverage *= facing + (1.0 - facing) * below;
  if (coverage > 0.0) {
    // What makes the mean over the covered part of a cell that is partly covered be `mean`.
    columns.depth_change[cell] =
        facing * columns.depth_change[cell] + (1.0 - facing) * 2.0 * mean / coverage;
  }
}

TORSION_WIDEST
void find_shares(const double* depth, const double* across, std::size_t count,
                 double* __restrict coverage) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double inside = depth[cell] > 0.0 ? 1.0 : 0.0;
    const double at_edge = 0.5 + depth[cell] / across[cell];
    coverage[cell] = 2.0 * std::abs(depth[cell]) >= across[cell] ? inside : at_edge;
  }
}

/// Leaves the coverage in the columns, and depth and coverage where beside an edge.
CellBits find_coverage(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  find_shares(columns.depth.data(), columns.depth_change.data(), columns.depth.size(),
              columns.coverage.data());
  CellBits covered{};
  std::size_t cell = 0;
  const double* normal = columns.points.gradient_z.data();
  double* coverage = columns.coverage.data();
  const bool spares = has_patch(grid.world, grid.identity) && patch_spare(grid.side) > 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    std::uint64_t row = 0;
    if (spares) {
      // Takes no part: there are as many columns on either side of a contact's middle.
      coverage[cell] = 0.0;
    }
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      if (normal[cell] < kFullyFacing && coverage[cell] > 0.0) {
        take_depth_from_plane(grid, cell, facing_share(normal[cell]));
      }
      row |= static_cast<std::uint64_t>(coverage[cell] > 0.0) << i;
    }
    covered[j] = row;
  }
  return covered;
}

/// From the columns to the table.
void store_cells(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    grid.cells[cell] = {columns.points.z[cell], columns.depth[cell], columns.coverage[cell]};
  }
}

/// @param place  m, grid
std::uint32_t cell_at(const Grid& grid, const glm::dvec3& place) {
  const auto index = [&grid](double position, double half) {
    const double scaled = (position / half + 1.0) * 0.5 * static_cast<double>(grid.side);
    return static_cast<std::uint32_t>(std::clamp(scaled, 0.0, static_cast<double>(grid.side - 1)));
  };
  return index(place.y, grid.frame.half_size.y) * grid.side +
         index(place.x, grid.frame.half_size.x);
}

void set(CellBits& bits, const Grid& grid, std::uint32_t cell) {
  bits[cell / grid.side] |= std::uint64_t{1} << (cell % grid.side);
}

/// Adds to `bits` their free neighbours, those across a corner too. True when there were any.
bool spread_one_step(const Grid& grid, CellBits& free, CellBits& bits) {
  std::uint64_t any = 0;
  std::uint64_t before = 0;  // the row before, as it was
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    const std::uint64_t after = j + 1 < grid.side ? bits[j + 1] : 0;
    const std::uint64_t rows = before | bits[j] | after;
    const std::uint64_t fresh = (rows | rows << 1 | rows >> 1) & free[j];
    before = bits[j];
    bits[j] |= fresh;
    free[j] &= ~fresh;
    any |= fresh;
  }
  return any != 0;
}

/// Takes the coverage from cells that are not joined to the region's own contact points, or are
/// nearer to those of another cluster, in steps from cell to cell. Returns those that keep it.
CellBits keep_own_cells(const Grid& grid, const RegionPoints& contact, const CellBits& covered) {
  const CellColumns& columns = grid.scratch.cell_columns;
  CellBits free = covered;
  CellBits own{};
  CellBits foreign{};
  bool any_own = false;
  bool any_foreign = false;
  const glm::dvec2 reach = grid.frame.half_size;
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    const glm::dvec3 place = body_to_grid(grid.frame, point.position);
    if (std::abs(place.x) <= reach.x && std::abs(place.y) <= reach.y) {
      const std::uint32_t cell = cell_at(grid, place);
      const bool is_own = point.cluster == contact.cluster;
      if (columns.coverage[cell] > 0.0) {
        set(is_own ? own : foreign, grid, cell);
        any_own = any_own || is_own;
        any_foreign = any_foreign || !is_own;
      }
    }
  }
  if (!any_own) {
    // The points fall between the cells: the deepest cell is the nearest thing to them.
    const auto deepest = std::ranges::max_element(columns.depth);
    set(own, grid, static_cast<std::uint32_t>(deepest - columns.depth.begin()));
  }
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    foreign[j] &= ~own[j];
    own[j] &= free[j];
    free[j] &= ~(own[j] | foreign[j]);
  }
  for (bool more = true; more;) {
    more = spread_one_step(grid, free, own);
    more = (any_foreign && spread_one_step(grid, free, foreign)) || more;
  }
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t lost = covered[j] & ~own[j]; lost != 0; lost &= lost - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(lost));
      columns.coverage[std::size_t{j} * grid.side + i] = 0.0;
    }
  }
  return own;
}

}  // namespace

Pose grid_in_body(const RegionFrame& frame) {
  return {frame.origin, glm::quat_cast(glm::dmat3(frame.tangent_x, frame.tangent_y, frame.normal))};
}

Pose grid_in_tool(const Grid& grid) {
  const Pose tool_in_body = relative(grid.world.bodies.at<Pose>(grid.identity.body),
                                     grid.world.tools.at<ToolPose>(grid.identity.tool).now);
  return relative(tool_in_body, moved_grid_in_body(grid));
}

CellBits covered_cells(const Grid& grid) {
  CellBits covered{};
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      covered[j] |= static_cast<std::uint64_t>(grid.cells[cell].coverage > 0.0) << i;
    }
  }
  return covered;
}

CellBits find_cells(const Grid& grid, const RegionPoints& contact) {
  place_centers(grid);
  return_from_above(grid);
  find_tool_surface(grid);
  find_rest_surface(grid);
  const CellColumns& columns = grid.scratch.cell_columns;
  find_depths(columns.points, columns.depth.size(), columns.depth.data());
  find_depth_changes(columns, cell_half_size(grid), columns.depth.size(),
                     columns.depth_change.data());
  const CellBits own = keep_own_cells(grid, contact, find_coverage(grid));
  store_cells(grid);
  return own;
}

}  // namespace torsion
