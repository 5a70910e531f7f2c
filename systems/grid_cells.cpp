#include "systems/grid_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/frames.hpp"

namespace torsion {
namespace {

constexpr int kMostSurfaceSteps = 10;  // of Newton's method down to the tool's surface
constexpr double kSteepest =
    0.25;  // smallest |cosine| between a surface's normal and the grid's that is divided by

/// The cells' centres at their present heights in the tool's frame, and the grid's axes there.
struct ToolGrid {
  glm::dvec3 origin, x, y, z;
};

ToolGrid grid_in_tool(const Grid& grid) {
  const Pose tool_in_body = relative(grid.world.bodies.at<Pose>(grid.identity.body),
                                     grid.world.tools.at<ToolPose>(grid.identity.tool).now);
  const glm::dquat to_tool = glm::conjugate(tool_in_body.rotation);
  return {to_inner(tool_in_body, grid.frame.origin), to_tool * grid.frame.tangent_x,
          to_tool * grid.frame.tangent_y, to_tool * grid.frame.normal};
}

void place_points(const Grid& grid, const ToolGrid& axes) {
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
      grid.scratch.cell_points[cell] =
          axes.origin + axes.x * center.x + axes.y * center.y + axes.z * grid.cells[cell].height;
    }
  }
}

/// Radius about the grid's origin that holds what of a surface can lie under the cells' centres and
/// below the rest surface.
double reach_of(const Grid& grid) {
  double deepest = 0.0;
  for (const CellGeometry& cell : grid.cells) {
    deepest = std::max(deepest, -cell.height);
  }
  return glm::length(grid.frame.half_size) + deepest;
}

/// Cells that found nothing of the tool near the rest surface look again from below: where they are
/// now may be above the tool, and from there no step leads to its underside.
void return_from_above(const Grid& grid) {
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  double lowest = 0.0;
  for (const CellGeometry& cell : grid.cells) {
    lowest = std::min(lowest, cell.height);
  }
  for (CellGeometry& cell : grid.cells) {
    cell.height = cell.height < 0.5 * size ? cell.height : lowest;
  }
}

/// Newton's method along the normal from every cell to the tool's underside. Leaves in scratch the
/// distances at the last heights but one; the gradient there is the surface's normal.
void find_tool_surface(const Grid& grid, const ToolGrid& axes) {
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  const auto parts =
      parts_near(grid.world, grid.world.tools.at<OwnedRows>(grid.identity.tool).parts, axes.origin,
                 reach_of(grid), grid.scratch.near_parts);
  const double close_enough = 0.02 * size / static_cast<double>(grid.side);
  for (int step = 0; step < kMostSurfaceSteps; ++step) {
    place_points(grid, axes);
    signed_distances(grid.world, parts, grid.scratch.cell_points, grid.scratch.cell_distances);
    double farthest = 0.0;
    for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
      const Distance& distance = grid.scratch.cell_distances[cell];
      const double slope = std::max(-glm::dot(distance.gradient, axes.z), kSteepest);
      double& height = grid.cells[cell].height;
      const double change = distance.value / slope;
      // Above the rest surface there is no contact, however far away the tool is.
      height = std::min(height + change, size);
      farthest = std::max(farthest, height < 0.0 ? std::abs(change) : 0.0);
    }
    if (farthest < close_enough) {
      break;
    }
  }
}

/// Depth under the body's rest surface and covered share of each cell, from the surfaces'
/// first-order shape there.
void find_depths(const Grid& grid, const ToolGrid& axes) {
  Scratch& scratch = grid.scratch;
  const RegionFrame& frame = grid.frame;
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    const glm::dvec3& gradient = scratch.cell_distances[cell].gradient;
    scratch.cell_normals[cell] = {glm::dot(gradient, axes.x), glm::dot(gradient, axes.y),
                                  glm::dot(gradient, axes.z)};
  }
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      scratch.cell_points[cell] = grid_to_body(
          frame, glm::dvec3(cell_center(frame, grid.side, i, j), grid.cells[cell].height));
    }
  }
  const auto parts =
      parts_near(grid.world, grid.world.bodies.at<OwnedRows>(grid.identity.body).parts,
                 frame.origin, reach_of(grid), scratch.near_parts);
  signed_distances(grid.world, parts, scratch.cell_points, scratch.cell_distances);
  const glm::dvec2 half = cell_half_size(grid);
  for (cell = 0; cell < grid.cells.size(); ++cell) {
    const Distance& body = scratch.cell_distances[cell];
    const glm::dvec3 body_normal = body_to_grid_direction(frame, body.gradient);
    const glm::dvec3& tool_normal = scratch.cell_normals[cell];
    const double over_body_slope = 1.0 / std::max(body_normal.z, kSteepest);
    const double over_tool_slope = 1.0 / std::max(-tool_normal.z, kSteepest);
    CellGeometry& geometry = grid.cells[cell];
    geometry.depth = -body.value * over_body_slope;
    // How much the depth changes across the cell: the share of the cell with depth > 0, to first
    // order.
    const double change_x = tool_normal.x * over_tool_slope + body_normal.x * over_body_slope;
    const double change_y = tool_normal.y * over_tool_slope + body_normal.y * over_body_slope;
    const double across = 2.0 * (std::abs(change_x) * half.x + std::abs(change_y) * half.y) + 1e-30;
    scratch.cell_depth_changes[cell] = across;
    geometry.coverage = 2.0 * std::abs(geometry.depth) >= across
                            ? (geometry.depth > 0.0 ? 1.0 : 0.0)
                            : 0.5 + geometry.depth / across;
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
CellBits keep_own_cells(const Grid& grid, const RegionPoints& contact) {
  CellBits free = covered_cells(grid);
  CellBits own{};
  CellBits foreign{};
  bool any_own = false;
  const glm::dvec2 reach = grid.frame.half_size;
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    const glm::dvec3 place = body_to_grid(grid.frame, point.position);
    if (std::abs(place.x) <= reach.x && std::abs(place.y) <= reach.y) {
      const std::uint32_t cell = cell_at(grid, place);
      const bool is_own = point.cluster == contact.cluster;
      if (grid.cells[cell].coverage > 0.0) {
        set(is_own ? own : foreign, grid, cell);
        any_own = any_own || is_own;
      }
    }
  }
  if (!any_own) {
    // The points fall between the cells: the deepest cell is the nearest thing to them.
    const auto deepest = std::ranges::max_element(grid.cells, {}, &CellGeometry::depth);
    set(own, grid, static_cast<std::uint32_t>(deepest - grid.cells.begin()));
  }
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    foreign[j] &= ~own[j];
    own[j] &= free[j];
    free[j] &= ~(own[j] | foreign[j]);
  }
  for (bool more = true; more;) {
    more = spread_one_step(grid, free, own);
    more = spread_one_step(grid, free, foreign) || more;
  }
  for (std::uint32_t cell = 0; cell < grid.cells.size(); ++cell) {
    if ((own[cell / grid.side] >> (cell % grid.side) & 1U) == 0) {
      grid.cells[cell].coverage = 0.0;
    }
  }
  return own;
}

}  // namespace

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
  const ToolGrid axes = grid_in_tool(grid);
  return_from_above(grid);
  find_tool_surface(grid, axes);
  find_depths(grid, axes);
  return keep_own_cells(grid, contact);
}

}  // namespace torsion
