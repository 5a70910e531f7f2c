#include "systems/region_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "systems/distance_shapes.hpp"
#include "systems/frames.hpp"
#include "systems/grid_cells.hpp"
#include "systems/patch_grid.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

constexpr int kMostPasses = 10;  // of one grid in one step: a new region finds its size by doubling
constexpr double kSmallestFill = 0.45;  // of the grid by the contact, else the grid is made smaller
constexpr double kSettled =
    0.02;  // of the grid: what it is off by when a region begins, splits or takes over another
constexpr double kSteepest =
    0.25;  // smallest cosine between the surface's normal and the grid's that is divided by
constexpr double kSmallestHalf = 1e-9;  // m
constexpr int kCenteringPasses = 24;    // of a new grid of contact model patch
constexpr double kCentered = 1e-10;     // of the grid

/// A box in the grid's plane; empty while lowest > highest.
struct PlaneBox {
  glm::dvec2 lowest{1e300};
  glm::dvec2 highest{-1e300};
  void include(const glm::dvec2& low, const glm::dvec2& high) {
    lowest = glm::min(lowest, low);
    highest = glm::max(highest, high);
  }
  [[nodiscard]] bool empty() const { return lowest.x > highest.x || lowest.y > highest.y; }
};

/// The highest set bit alone.
std::uint64_t last_bit(std::uint64_t bits) {
  return bits == 0 ? 0 : std::uint64_t{1} << (63 - std::countl_zero(bits));
}

/// The contact as the last pass found it: covered cells, cut where their coverage says that the
/// edge runs.
PlaneBox covered_box(const Grid& grid, const CellBits& covered) {
  PlaneBox box;
  std::optional<glm::dvec2> middle;  // of some covered cell
  const glm::dvec2 half = cell_half_size(grid);
  const double step = 2.0 / static_cast<double>(grid.side);
  const auto include = [&](std::uint32_t i, std::uint32_t j) {
    // As cell_center, without its division.
    const glm::dvec2 cell(static_cast<double>(i), static_cast<double>(j));
    const glm::dvec2 center = grid.frame.half_size * ((cell + 0.5) * step - 1.0);
    // At less than half coverage the edge is short of the centre: the reach is negative, and this
    // grows with the coverage without a jump.
    const glm::dvec2 reach = half * (2.0 * grid.cells[j * grid.side + i].coverage - 1.0);
    box.include(center - reach, center + reach);
    middle = center;
  };
  // A cell reaches no farther than a covered neighbour outside of it, so the outermost of each row
  // and all of the outermost rows say it all.
  const auto any = [](std::uint64_t row) {
    return row != 0;
  };
  const auto first = std::ranges::find_if(covered, any) - covered.begin();
  const auto last = covered.rend() - std::find_if(covered.rbegin(), covered.rend(), any) - 1;
  for (std::ptrdiff_t j = first; j <= last; ++j) {
    const auto row = static_cast<std::uint32_t>(j);
    for (std::uint64_t left = covered[row]; left != 0;) {
      include(static_cast<std::uint32_t>(std::countr_zero(left)), row);
      const bool outermost = j == first || j == last;
      left = outermost ? left & (left - 1) : last_bit(left & (left - 1));
    }
  }
  if (box.empty() && middle) {
    box.include(*middle, *middle);
  }
  return box;
}

/// Half the sides of the grid that suits a contact. A sliver is given a tenth of its length in
/// width, so that no cell degenerates.
glm::dvec2 half_size_for(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 half = 0.5 * (box.highest - box.lowest);
  if (has_patch(grid.world, grid.identity)) {
    return patch_half_size(kGridMargin * glm::max(half, glm::dvec2(kSmallestHalf)));
  }
  const double least = std::max(0.1 * std::max(half.x, half.y), kSmallestHalf);
  return kGridMargin * glm::max(half, glm::dvec2(least));
}

/// Outward normal of the body's surface nearest to a point of its frame.
glm::dvec3 body_normal(const Grid& grid, const glm::dvec3& point) {
  return glm::normalize(
      signed_distance(grid.world, grid.world.bodies.at<OwnedRows>(grid.identity.body).parts, point)
          .gradient);
}

/// Puts the grid around `box` (of its own plane) and its origin back on the body's rest surface.
void fit(const Grid& grid, const PlaneBox& box) {
  RegionFrame& frame = grid.frame;
  frame.half_size = half_size_for(grid, box);
  frame.origin += tangent_to_body(frame, 0.5 * (box.lowest + box.highest));
  const Distance surface = signed_distance(
      grid.world, grid.world.bodies.at<OwnedRows>(grid.identity.body).parts, frame.origin);
  frame.origin -= frame.normal *
                  (surface.value / std::max(glm::dot(surface.gradient, frame.normal), kSteepest));
}

void turn_about_normal(RegionFrame& frame, double angle) {
  const glm::dvec3 x = frame.tangent_x;
  const glm::dvec3 y = frame.tangent_y;
  frame.tangent_x = std::cos(angle) * x + std::sin(angle) * y;
  frame.tangent_y = std::cos(angle) * y - std::sin(angle) * x;
}

/// Where the contact sticks, the material went along with the tool in the last step: the grid turns
/// with it, and the place of the tractions moves with it. Without this a long contact that sticks
/// and turns would seem to leave the area that it holds, for contact is found against the rest
/// shape.
void follow_material(World& world, std::uint32_t region) {
  RegionFrame& frame = world.regions.at<RegionFrame>(region);
  RegionFrame& tractions = world.regions.at<TractionFrame>(region).frame;
  const RegionMotion& motion = world.regions.at<RegionMotion>(region);
  const double share = world.regions.at<RegionFriction>(region).stick_share;
  const double angle = share * motion.spin;
  const glm::dvec3 pivot = grid_to_body(frame, {motion.pivot, 0.0});
  const glm::dvec3 slide = tangent_to_body(frame, share * motion.slide);
  const glm::dvec3 arm = tractions.origin - pivot;
  tractions.origin += slide + std::sin(angle) * glm::cross(frame.normal, arm);
  turn_about_normal(tractions, angle);
  turn_about_normal(frame, angle);
}

/// True when the contact reaches the grid's edge, so that some of it may lie outside.
bool reaches_edge(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 inner = grid.frame.half_size - cell_half_size(grid);
  return box.lowest.x < -inner.x || box.lowest.y < -inner.y || box.highest.x > inner.x ||
         box.highest.y > inner.y;
}

bool fills_too_little(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 fill = (box.highest - box.lowest) / (2.0 * grid.frame.half_size);
  return std::max(fill.x, fill.y) < kSmallestFill;
}

void restart_heights(const Grid& grid, double depth) {
  for (CellGeometry& cell : grid.cells) {
    cell.height = -depth;
  }
}

/// True when a further pass would leave the grid where it is.
bool settled(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 change = glm::abs(half_size_for(grid, box) - grid.frame.half_size);
  const glm::dvec2 shift = glm::abs(0.5 * (box.lowest + box.highest));
  const glm::dvec2 off = glm::max(change, shift) / grid.frame.half_size;
  return std::max(off.x, off.y) < kSettled;
}

/// Passes over the grid until it holds the whole contact and little else. In most steps it does at
/// once, and moves with the contact from step to step; when something happened to the region it
/// settles within the step, so that what fades in is not the grid's way to its place.
void find_contact(const Grid& grid, const RegionPoints& contact, double start_depth,
                  bool event_now) {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    PlaneBox box = covered_box(grid, find_cells(grid, contact));
    if (box.empty()) {
      return;
    }
    if (reaches_edge(grid, box)) {
      box.lowest -= 0.5 * grid.frame.half_size;
      box.highest += 0.5 * grid.frame.half_size;
    } else if (event_now ? settled(grid, box) : !fills_too_little(grid, box)) {
      return;
    }
    fit(grid, box);
    restart_heights(grid, start_depth);
  }
}

/// Middle of the overlap in the grid's plane, weighted with its depth, m.
glm::dvec2 overlap_middle(const Grid& grid) {
  double sum = 0.0;
  glm::dvec2 moment(0.0);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const double weight = grid.cells[cell].coverage * std::max(grid.cells[cell].depth, 0.0);
      sum += weight;
      moment += weight * cell_center(grid.frame, grid.side, i, j);
    }
  }
  return sum > 0.0 ? moment / sum : glm::dvec2(0.0);
}

/// Lays a new grid of contact model `patch` by the overlap alone: where the tool's samples lie must
/// not matter, or mirrored motions would differ. Every pass finds the overlap on the grid of the
/// last one; what depends on how its cells lie fades by a power of ten each.
void center_patch(const Grid& grid, const RegionPoints& contact, double start_depth) {
  const double side = static_cast<double>(grid.side);
  for (int pass = 0; pass < kCenteringPasses; ++pass) {
    const PlaneBox box = covered_box(grid, find_cells(grid, contact));
    if (box.empty()) {
      return;
    }
    const glm::dvec2 before = grid.frame.half_size;
    const glm::dvec2 off = patch_middle(grid.side) / side * 2.0 - 1.0;  // of the half sides
    const glm::dvec2 middle = overlap_middle(grid);
    const glm::dvec2 half = half_size_for(grid, box);
    const glm::dvec2 shift = middle - off * half;
    fit(grid, {middle - off * half - half / kGridMargin, middle - off * half + half / kGridMargin});
    turn_normal_to(grid.frame, body_normal(grid, grid.frame.origin));
    restart_heights(grid, start_depth);
    const glm::dvec2 change = glm::max(glm::abs(shift), glm::abs(half - before)) / half;
    if (std::max(change.x, change.y) < kCentered) {
      break;
    }
  }
  find_cells(grid, contact);
}

/// Sums over a grid's cells in contact, every eighth one after another.
struct alignas(64) GeometryLanes {
  using Lane = std::array<double, 8>;
  Lane area{}, volume{}, depth{}, x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{};
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
      const double counted = larger(2.0 * shared - 1.0, 0.0) * cell_area * facing_share(slope_z);
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

double sum(const GeometryLanes::Lane& lane) {
  return std::accumulate(lane.begin(), lane.end(), 0.0);
}

/// Area, depths, pressure centre and mean normal from the cells.
RegionGeometry summarize(const Grid& grid) {
  GeometryLanes lanes;
  add_up(grid.scratch.cell_columns, cell_area(grid.frame, grid.side), grid.cells.size(), lanes);
  RegionGeometry geometry;
  geometry.equivalent_point = grid.frame.origin;
  geometry.rest_point = grid.frame.origin;
  geometry.mean_normal = grid.frame.normal;
  geometry.area = sum(lanes.area);
  geometry.largest_depth = *std::ranges::max_element(lanes.depth);
  if (geometry.area <= 0.0) {
    return geometry;
  }
  const glm::dvec3 first_moment(sum(lanes.x), sum(lanes.y), sum(lanes.z));
  geometry.equivalent_point = grid_to_body(grid.frame, first_moment / geometry.area);
  geometry.mean_depth = sum(lanes.volume) / geometry.area;
  geometry.rest_point = geometry.equivalent_point + grid.frame.normal * geometry.mean_depth;
  geometry.radius = std::sqrt(geometry.area / std::numbers::pi);
  const glm::dvec3 normal(sum(lanes.normal_x), sum(lanes.normal_y), sum(lanes.normal_z));
  if (glm::length(normal) > 0.1 * geometry.area) {
    geometry.mean_normal = glm::normalize(tangent_to_body(grid.frame, glm::dvec2(normal)) +
                                          grid.frame.normal * normal.z);
  }
  return geometry;
}

double deepest_point(std::span<const ContactPoint> points, std::uint32_t cluster,
                     glm::dvec3& position) {
  double depth = 0.0;
  for (const ContactPoint& point : points) {
    if (point.cluster == cluster && point.depth > depth) {
      depth = point.depth;
      position = point.position;
    }
  }
  return depth;
}

void include_points(const Grid& grid, const RegionPoints& contact, PlaneBox& box) {
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    if (point.cluster == contact.cluster) {
      const glm::dvec2 in_grid(body_to_grid(grid.frame, point.position));
      box.include(in_grid, in_grid);
    }
  }
}

/// The region's contact in this step, findable by its block of cells, which stays when rows move.
RegionPoints& contact_of(StepContext& context, const RegionIdentity& region) {
  return context.scratch.region_points[block_of(region)];
}

}  // namespace

void place_new_grid(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  contact_of(context, grid.identity) = contact;
  glm::dvec3 deepest(0.0);
  const double depth = deepest_point(points_of(grid.scratch, contact), contact.cluster, deepest);
  const Distance surface = signed_distance(
      grid.world, grid.world.bodies.at<OwnedRows>(grid.identity.body).parts, deepest);
  RegionFrame& frame = grid.frame;
  frame = RegionFrame{};
  frame.origin = deepest;
  turn_normal_to(frame, glm::normalize(surface.gradient));
  PlaneBox box;
  const glm::dvec2 start(2.0 * depth);
  box.include(-start, start);
  include_points(grid, contact, box);
  fit(grid, box);
  restart_heights(grid, depth);
}

void follow_contact(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  contact_of(context, grid.identity) = contact;
  if (has_patch(context.world, grid.identity)) {
    follow_patch(context, region, contact);
    turn_normal_to(grid.frame, context.world.regions.at<RegionGeometry>(region).mean_normal);
    return;
  }
  // The springs of mdr are round: they need no grid that turns with what sticks.
  if (context.world.bodies.at<BodyModels>(grid.identity.body).contact != ContactModel::kMdr) {
    follow_material(context.world, region);
  }
  PlaneBox box = covered_box(grid, covered_cells(grid));
  include_points(grid, contact, box);
  if (!box.empty()) {
    fit(grid, box);
  }
  turn_normal_to(grid.frame, context.world.regions.at<RegionGeometry>(region).mean_normal);
}

void region_grids(StepContext& context) {
  for (std::uint32_t region = 0; region < context.world.regions.size(); ++region) {
    const Grid grid = grid_of(context, region);
    const RegionPoints& contact = contact_of(context, grid.identity);
    if (has_patch(context.world, grid.identity) &&
        context.world.regions.at<PatchState>(region).started != 0) {
      find_cells(grid, contact);
    } else {
      glm::dvec3 deepest(0.0);
      const double depth =
          deepest_point(points_of(grid.scratch, contact), contact.cluster, deepest);
      find_contact(grid, contact, depth,
                   context.world.regions.at<RegionWrench>(region).event_now != 0);
      if (has_patch(context.world, grid.identity)) {
        center_patch(grid, contact, depth);
      }
    }
    context.world.regions.at<RegionGeometry>(region) = summarize(grid);
  }
}

}  // namespace torsion
