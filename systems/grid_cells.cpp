#include "systems/grid_cells.hpp"

#include <algorithm>
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

/// Radius about the grid's origin that holds the cells' centres at their present heights and, with
/// the same again, where they move in a pass.
double reach_of(const Grid& grid) {
  double farthest = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  for (const CellGeometry& cell : grid.cells) {
    farthest = std::max(farthest, -cell.height);
  }
  return glm::length(grid.frame.half_size) + farthest;
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
    const double body_slope = std::max(body_normal.z, kSteepest);
    const double tool_slope = std::max(-tool_normal.z, kSteepest);
    CellGeometry& geometry = grid.cells[cell];
    geometry.depth = -body.value / body_slope;
    // How much the depth changes across the cell: the share of the cell with depth > 0, to first
    // order.
    const double change_x = tool_normal.x / tool_slope + body_normal.x / body_slope;
    const double change_y = tool_normal.y / tool_slope + body_normal.y / body_slope;
    const double across = 2.0 * (std::abs(change_x) * half.x + std::abs(change_y) * half.y) + 1e-30;
    scratch.cell_depth_changes[cell] = across;
    geometry.coverage = std::clamp(0.5 + geometry.depth / across, 0.0, 1.0);
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

constexpr std::uint8_t kUnvisited = 0;
constexpr std::uint8_t kOwn = 1;
constexpr std::uint8_t kForeign = 2;

/// Marks a covered cell for the first who reaches it and queues it.
void visit(const Grid& grid, std::uint32_t cell, std::uint8_t mark, std::uint32_t& filled) {
  auto& marks = grid.scratch.cell_marks;
  if (marks[cell] == kUnvisited && grid.cells[cell].coverage > 0.0) {
    marks[cell] = mark;
    grid.scratch.cell_queue[filled++] = cell;
  }
}

/// Marks every covered cell that is joined to a queued one with the mark of the nearest, in steps
/// from cell to cell.
void spread(const Grid& grid, std::uint32_t filled) {
  for (std::uint32_t next = 0; next < filled; ++next) {
    const std::uint32_t cell = grid.scratch.cell_queue[next];
    const std::uint8_t mark = grid.scratch.cell_marks[cell];
    const std::uint32_t i = cell % grid.side;
    const std::uint32_t j = cell / grid.side;
    for (std::uint32_t row = j - std::min(j, 1U); row <= std::min(j + 1, grid.side - 1); ++row) {
      for (std::uint32_t column = i - std::min(i, 1U); column <= std::min(i + 1, grid.side - 1);
           ++column) {
        visit(grid, row * grid.side + column, mark, filled);
      }
    }
  }
}

/// Takes the coverage from cells that are not joined to the region's own contact points, or are
/// nearer to those of another cluster.
void keep_own_cells(const Grid& grid, const RegionPoints& contact) {
  auto& marks = grid.scratch.cell_marks;
  std::ranges::fill(marks, kUnvisited);
  std::uint32_t filled = 0;
  const glm::dvec2 reach = grid.frame.half_size;
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    const glm::dvec3 place = body_to_grid(grid.frame, point.position);
    if (std::abs(place.x) <= reach.x && std::abs(place.y) <= reach.y) {
      visit(grid, cell_at(grid, place), point.cluster == contact.cluster ? kOwn : kForeign, filled);
    }
  }
  if (std::ranges::find(marks, kOwn) == marks.end()) {
    // The points fall between the cells: the deepest cell that is left is the nearest thing to
    // them.
    std::uint32_t deepest = 0;
    for (std::uint32_t cell = 1; cell < grid.cells.size(); ++cell) {
      const bool better = grid.cells[cell].depth > grid.cells[deepest].depth;
      deepest =
          marks[cell] == kUnvisited && (better || marks[deepest] != kUnvisited) ? cell : deepest;
    }
    visit(grid, deepest, kOwn, filled);
  }
  spread(grid, filled);
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    grid.cells[cell].coverage = marks[cell] == kOwn ? grid.cells[cell].coverage : 0.0;
  }
}

}  // namespace

void find_cells(const Grid& grid, const RegionPoints& contact) {
  const ToolGrid axes = grid_in_tool(grid);
  find_tool_surface(grid, axes);
  find_depths(grid, axes);
  keep_own_cells(grid, contact);
}

}  // namespace torsion
