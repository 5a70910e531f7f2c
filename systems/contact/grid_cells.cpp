#include "systems/contact/grid_cells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "systems/contact/body_edges.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/overlap_normal.hpp"
#include "systems/contact/rims.hpp"
#include "systems/contact/tool_surface.hpp"
#include "systems/geometry/distance_shapes.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

/// Distance of the cells' places on the tool to the body's rest surface.
void find_rest_surface(const Grid& grid) {
  const auto parts = parts_under(grid, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts,
                                 grid.frame.origin);
  signed_distances(grid.model, parts, grid_in_body(grid.frame), grid.scratch.cell_columns.points);
}

/// Depth under the body's rest surface, its change across a cell, and the share of the cell that is
/// in contact, to first order in the shape of both surfaces there.
/// @param half  m: half a cell
TORSION_WIDEST
void find_depths(const glm::dvec2& half, std::size_t count, const double* __restrict value,
                 const double* __restrict body_x, const double* __restrict body_y,
                 const double* __restrict body_z, const double* __restrict tool_x,
                 const double* __restrict tool_y, double* __restrict depth,
                 double* __restrict depth_change, double* __restrict coverage,
                 double* __restrict bearing) {
  const double half_x = half.x;
  const double half_y = half.y;
  for (std::size_t first = 0; first < count; first += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t cell = first + lane;
      const double over_slope = 1.0 / larger(body_z[cell], kSteepest);
      const double deep = -value[cell] * over_slope;
      const double change_x = tool_x[cell] + body_x[cell] * over_slope;
      const double change_y = tool_y[cell] + body_y[cell] * over_slope;
      const double across =
          2.0 * (std::abs(change_x) * half_x + std::abs(change_y) * half_y) + 1e-30;
      const double inside = deep > 0.0 ? 1.0 : 0.0;
      const double at_edge = 0.5 + deep / across;
      const double share = 2.0 * std::abs(deep) >= across ? inside : at_edge;
      depth[cell] = deep;
      depth_change[cell] = across;
      coverage[cell] = share;
      bearing[cell] = share >= 0.5 ? 1.0 : 0.0;
    }
  }
}

/// 1 less the cosine between the grid's normal and that of a face that the tool reaches down to:
/// the largest of all cells, in lanes.
/// @param tool_z  m: of the cells' places on the tool
TORSION_WIDEST
void find_steepest(std::size_t count, const double* __restrict coverage,
                   const double* __restrict tool_z, const double* __restrict body_z,
                   Lanes& __restrict steepest) {
  Lanes most{};
  for (std::size_t first = 0; first < count; first += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t cell = first + lane;
      const double askew = 1.0 - body_z[cell];
      const double covered = coverage[cell] > 0.0 ? askew : 0.0;
      const double below = tool_z[cell] < 0.0 ? askew : 0.0;
      most[lane] = larger(larger(covered, below), most[lane]);
    }
  }
  steepest = most;
}

/// One bit a cell, one word a row: the cells that are covered, and those that may carry pressure.
/// @param coverage, bearing  (side x side)
/// @param bits               1, 2, 4, ...: shifts would hinder vectorisation
TORSION_WIDEST
void find_covered(const double* __restrict coverage, const double* __restrict bearing,
                  std::size_t side, const std::uint64_t* __restrict bits,
                  std::uint64_t* __restrict covered) {
  for (std::size_t j = 0; j < side; ++j) {
    const double* const along = coverage + j * side;
    const double* const bears = bearing + j * side;
    std::uint64_t row = 0;
    for (std::size_t i = 0; i < side; ++i) {
      row |= along[i] + bears[i] > 0.0 ? bits[i] : 0;
    }
    covered[j] = row;
  }
}

constexpr CellBits single_bits() {
  CellBits bits{};
  for (std::size_t i = 0; i < bits.size(); ++i) {
    bits[i] = std::uint64_t{1} << i;
  }
  return bits;
}

CellBits bits_of_covered(const Grid& grid) {
  static constexpr CellBits kBits = single_bits();
  CellBits covered{};
  find_covered(grid.scratch.cell_columns.coverage.data(), grid.scratch.cell_columns.bearing.data(),
               grid.side, kBits.data(), covered.data());
  return covered;
}

/// Depths and coverage under the cells' faces of the body.
/// @return the cosine between the grid's normal and that of the steepest of those
double find_depths(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const DistanceColumns& body = columns.points;
  const std::size_t count = columns.coverage.size();
  find_depths(cell_half_size(grid), count, body.value.data(), body.gradient_x.data(),
              body.gradient_y.data(), body.gradient_z.data(), columns.tool_x.data(),
              columns.tool_y.data(), columns.depth.data(), columns.depth_change.data(),
              columns.coverage.data(), columns.bearing.data());
  Lanes steepest;
  find_steepest(count, columns.coverage.data(), body.z.data(), body.gradient_z.data(), steepest);
  return 1.0 - largest_of(steepest);
}

/// Computes depth, its change and coverage into the columns.
/// @param rims  whether find_rims has found any
CellBits find_coverage(const Grid& grid, bool rims) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const std::size_t count = columns.coverage.size();
  double* const coverage = columns.coverage.data();
  double steepest = find_depths(grid);
  if (askew_share(steepest) > 0.0 && find_upper_faces(grid)) {
    steepest = find_depths(grid);
  }
  std::fill(coverage + count, coverage + (count + kLanes - 1) / kLanes * kLanes, 0.0);
  grid.scratch.body_edges = {askew_share(steepest), steepest < kFullyFacing, {}};
  if (grid.scratch.body_edges.ends) {
    cut_at_body_edges(grid);
  }
  if (rims) {
    take_rims(columns);
  }
  const ContactLaw& law = law_of(grid.model, grid.identity.body);
  const std::uint32_t spare = law.spare_columns != nullptr ? law.spare_columns(grid.side) : 0;
  for (std::size_t first = 0; spare > 0 && first < count; first += grid.side) {
    std::fill_n(&coverage[first], spare, 0.0);
    std::fill_n(&columns.bearing[first], spare, 0.0);
  }
  return bits_of_covered(grid);
}

/// Copies the columns into the table of cells.
void store_cells(const Grid& grid) {
  const CellColumns& columns = grid.scratch.cell_columns;
  const double* const z = columns.points.z.data();
  const double* const depth = columns.depth.data();
  const double* const coverage = columns.coverage.data();
  const double* const bearing = columns.bearing.data();
  CellGeometry* const cells = grid.cells.data();
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    cells[cell] = {z[cell], depth[cell], coverage[cell], bearing[cell]};
  }
}

/// Marks the cells under a region's contact points, those of other clusters in `foreign`.
/// @return true when there are any of others in the grid
bool mark_points(const Grid& grid, const RegionPoints& contact, CellBits& own, CellBits& foreign) {
  const CellFinder finder = finder_of(grid);
  bool any_foreign = false;
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    if (const auto cell = finder.under(point.position)) {
      const bool is_own = point.cluster == contact.cluster;
      (is_own ? own : foreign)[cell->j] |= std::uint64_t{1} << cell->i;
      any_foreign = any_foreign || !is_own;
    }
  }
  return any_foreign;
}

/// The deepest of these cells. (A cell beside a rim has a depth without being in contact.)
std::optional<CellPlace> deepest_of(const Grid& grid, const CellBits& cells) {
  std::optional<CellPlace> deepest;
  double most = 0.0;  // m
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t left = cells[j]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const double depth = grid.scratch.cell_columns.depth[std::size_t{j} * grid.side + i];
      if (!deepest || depth > most) {
        deepest = CellPlace{i, j};
        most = depth;
      }
    }
  }
  return deepest;
}

/// Removes the coverage of cells that are not connected to the region's own contact points, or that
/// are nearer, counted in cells, to those of another cluster. Returns the cells that remain.
CellBits keep_own_cells(const Grid& grid, const RegionPoints& contact, const CellBits& covered) {
  const CellColumns& columns = grid.scratch.cell_columns;
  CellBits free{};
  CellBits own{};
  CellBits foreign{};
  bool any_foreign = mark_points(grid, contact, own, foreign);
  std::uint64_t any_own = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    own[j] &= covered[j];
    foreign[j] &= covered[j] & ~own[j];
    any_own |= own[j];
  }
  if (any_own == 0) {
    // The contact points lie between cells: start from the deepest cell in contact instead.
    if (const auto cell = deepest_of(grid, covered)) {
      own[cell->j] = std::uint64_t{1} << cell->i;
      foreign[cell->j] &= ~own[cell->j];
    }
  }
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    free[j] = covered[j] & ~(own[j] | foreign[j]);
  }
  for (bool more = true; more;) {
    more = spread_one_step(grid.side, free, own);
    more = (any_foreign && spread_one_step(grid.side, free, foreign)) || more;
  }
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t lost = covered[j] & ~own[j]; lost != 0; lost &= lost - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(lost));
      columns.coverage[std::size_t{j} * grid.side + i] = 0.0;
      columns.bearing[std::size_t{j} * grid.side + i] = 0.0;
    }
  }
  return own;
}

}  // namespace

Pose grid_in_body(const RegionFrame& frame) {
  return {frame.origin, glm::quat_cast(glm::dmat3(frame.tangent_x, frame.tangent_y, frame.normal))};
}

Pose moved_grid_in_body(const RegionFrame& frame, const RegionCarrier& carrier,
                        const RegionSupport& support) {
  Pose moved = grid_in_body(frame);
  const double angle = glm::length(carrier.rotation);
  if (angle > 0.0) {
    moved.rotation = glm::angleAxis(angle, carrier.rotation / angle) * moved.rotation;
  }
  moved.position += carrier.translation;
  const double turn = glm::length(support.rotation);
  if (turn > 0.0) {
    const glm::dquat rotation = glm::angleAxis(turn, support.rotation / turn);
    moved.rotation = rotation * moved.rotation;
    moved.position = support.about + rotation * (moved.position - support.about);
  }
  moved.position += support.translation;
  return moved;
}

Pose grid_in_tool(const Grid& grid) {
  const Pose tool_in_body = relative(grid.state.bodies.at<BodyPose>(grid.identity.body).now,
                                     grid.state.tools.at<ToolPose>(grid.identity.tool).now);
  return relative(tool_in_body, moved_grid_in_body(grid.frame, grid.carrier, grid.support));
}

void cell_centers(const RegionFrame& frame, std::uint32_t side, std::span<double> x,
                  std::span<double> y) {
  for (std::uint32_t i = 0; i < side; ++i) {
    x[i] = cell_center(frame, side, i, 0).x;
  }
  for (std::uint32_t j = 0; j < side; ++j) {
    const std::size_t row = std::size_t{j} * side;
    std::fill_n(&y[row], side, cell_center(frame, side, 0, j).y);
    if (j > 0) {
      std::copy_n(x.begin(), side, &x[row]);
    }
  }
}

bool spread_one_step(std::uint32_t side, CellBits& free, CellBits& bits) {
  std::uint64_t any = 0;
  std::uint64_t before = 0;  // the row before, as it was
  for (std::uint32_t j = 0; j < side; ++j) {
    const std::uint64_t after = j + 1 < side ? bits[j + 1] : 0;
    const std::uint64_t rows = before | bits[j] | after;
    const std::uint64_t fresh = (rows | rows << 1 | rows >> 1) & free[j];
    before = bits[j];
    bits[j] |= fresh;
    free[j] &= ~fresh;
    any |= fresh;
  }
  return any != 0;
}

CellBits covered_cells(const Grid& grid) {
  double* const coverage = grid.scratch.cell_columns.coverage.data();
  double* const bearing = grid.scratch.cell_columns.bearing.data();
  for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
    coverage[cell] = grid.cells[cell].coverage;
    bearing[cell] = grid.cells[cell].bearing;
  }
  return bits_of_covered(grid);
}

CellBits find_cells(const Grid& grid, const RegionPoints& contact) {
  find_tool_surface(grid);
  const bool rims = find_rims(grid);
  find_rest_surface(grid);
  const CellBits own = keep_own_cells(grid, contact, find_coverage(grid, rims));
  store_cells(grid);
  return own;
}

namespace {

/// Sums over a grid's cells in contact, in eight lanes.
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
      // Overlap per covered area: the depth is zero at the edge of the contact and rises linearly
      // into the cell.
      const double at_edge = 0.5 * shared * depth_change[cell];
      const double volume = share * (shared < 1.0 ? at_edge : deep);
      // The slope of the cells whose centre is over the body, on the face that is pressed.
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
  const glm::dvec3 faces(sum_of(lanes.normal_x), sum_of(lanes.normal_y), sum_of(lanes.normal_z));
  const glm::dvec3 known =
      glm::length(faces) > 0.1 * overlap.area ? faces : glm::dvec3(0.0, 0.0, 1.0);
  const glm::dvec3 normal = grid.scratch.body_edges.askew > 0.0
                                ? normal_beside_edges(grid, glm::normalize(known))
                                : known;
  overlap.mean_normal = glm::normalize(tangent_to_body(grid.frame, glm::dvec2(normal)) +
                                       grid.frame.normal * normal.z);
  return overlap;
}

}  // namespace torsion::engine
