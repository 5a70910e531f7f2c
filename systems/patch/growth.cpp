#include "systems/patch/growth.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "systems/contact/tool_motion.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/loaded_cells.hpp"

namespace torsion::engine {
namespace {

constexpr double kLeastGrowth = 1.25;
constexpr double kMostGrowth = 8.0;
constexpr double kSlightlyDeeper =
    1.1;  // times the depth of the last step: a ball contact wider by 5 %
constexpr double kMuchDeeper = 4.0;      // what was loaded says less then than the overlap
constexpr double kMostWider = 16.0;      // in one step
constexpr double kLoadedOverlap = 0.85;  // of the overlap's extent: a ball's contact takes 0.71, a
                                         // punch's all of it

/// Moments of what is spread over cells.
struct Gathered {
  double weight = 0.0;
  glm::dvec2 first{0.0};
  glm::dvec2 second{0.0};

  void add(double share, const glm::dvec2& place) {
    weight += share;
    first += share * place;
    second += share * place * place;
  }
  /// Along each axis, about the middle.
  [[nodiscard]] glm::dvec2 variance() const {
    const glm::dvec2 middle = first / weight;
    return glm::max(second / weight - middle * middle, glm::dvec2(0.0));
  }
};

/// The overlap on a larger grid.
struct SeenOverlap {
  PlaneBox box;            // m, from the origin of the region's grid
  glm::dvec2 growth{1.0};  // by which that cuts it off (growth_at_edges)
  glm::dvec2 powers{0.0};  // its extent grows with these powers of the depth
};

/// With which powers of the depth an overlap's extents along the axes grow. Its area grows with the
/// depth's m-th power: m is the largest depth over the mean one, less 1. An axis has the more of m
/// the more the depth gathers the overlap about its middle along it: 1 of a ball, a half along
/// each; 2 of a cone; 0 of a punch; 1 of a tilted punch, across its edge.
glm::dvec2 growth_powers(const Grid& grid) {
  Gathered area;
  Gathered volume;
  double deepest = 0.0;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const CellGeometry& geometry = grid.cells[cell];
      const double depth = std::max(geometry.depth, 0.0);
      const glm::dvec2 place = cell_center(grid.frame, grid.side, i, j);
      area.add(geometry.coverage, place);
      volume.add(geometry.coverage * depth, place);
      deepest = geometry.coverage > 0.0 ? std::max(deepest, depth) : deepest;
    }
  }
  if (volume.weight <= 0.0) {
    return glm::dvec2(0.0);
  }
  const double power = std::clamp(deepest * area.weight / volume.weight - 1.0, 0.0, 2.0);
  const glm::dvec2 gathers =
      glm::max(area.variance() / glm::max(volume.variance(), 1e-300) - 1.0, glm::dvec2(0.0));
  const double both = gathers.x + gathers.y;
  return both > 0.0 ? glm::min(power / both * gathers, glm::dvec2(1.0)) : glm::dvec2(0.5 * power);
}

/// The overlap on a grid of the same axes that is larger by `growth` and lies around the middle of
/// the loaded cells: mirrored contacts are mirrored on it.
SeenOverlap overlap_around(const Grid& grid, const RegionPoints& contact, const PlaneBox& loaded,
                           const glm::dvec2& growth, double depth) {
  constexpr double kLittle = 0.1;  // of the largest depth
  const RegionFrame before = grid.frame;
  const RegionCarrier carrier = grid.carrier;
  const glm::dvec2 half_size = growth * before.half_size;
  const glm::dvec2 shift =
      0.5 * (loaded.lowest + loaded.highest) - middle_in_grid(grid.side) * half_size;
  shift_origin(grid, shift);
  grid.frame.half_size = half_size;
  restart_heights(grid, depth);
  SeenOverlap seen;
  const CellBits cells = find_cells(grid, contact);
  seen.box = covered_box(grid, cells);
  if (!seen.box.empty()) {
    seen.box = {seen.box.lowest + shift, seen.box.highest + shift};
    seen.growth = growth_at_edges(grid, cells, kLittle);
    seen.powers = growth_powers(grid);
  }
  grid.frame = before;
  grid.carrier = carrier;
  restart_heights(grid, depth);
  return seen;
}

/// The overlap of a contact that has got deeper by a factor, on a grid that holds it.
SeenOverlap whole_overlap(const Grid& grid, const RegionPoints& contact, const PlaneBox& loaded,
                          double deeper, double depth) {
  constexpr int kPasses = 5;
  glm::dvec2 growth(std::min(std::sqrt(deeper), kMostWider));  // Hertz: a^2 = R d
  SeenOverlap seen = overlap_around(grid, contact, loaded, growth, depth);
  for (int pass = 1; pass < kPasses && seen.growth != glm::dvec2(1.0); ++pass) {
    growth *= seen.growth;
    seen = overlap_around(grid, contact, loaded, growth, depth);
  }
  return seen;
}

/// As Overlap's, m.
double largest_depth(const Grid& grid) {
  double depth = 0.0;
  for (const CellGeometry& cell : grid.cells) {
    depth = std::max(depth, cell.coverage > 0.0 ? cell.depth : 0.0);
  }
  return depth;
}

/// Share of an overlap's extent that carries pressure, with some room: of a punch 1, of a ball
/// 0.71, of a cone 0.64 (Johnson, Contact Mechanics, 1985, 3.4, 4.2 and 5.2).
glm::dvec2 loaded_share(const glm::dvec2& powers) {
  return 1.0 - 0.4 * glm::min(powers, 0.5);
}

/// A box that is `ratio` times as wide.
PlaneBox widened(const PlaneBox& box, const glm::dvec2& ratio) {
  const glm::dvec2 middle = 0.5 * (box.lowest + box.highest);
  const glm::dvec2 half = 0.5 * ratio * (box.highest - box.lowest);
  return {middle - half, middle + half};
}

}  // namespace

glm::dvec2 growth_at_edges(const Grid& grid, const CellBits& cells, double little) {
  const std::uint32_t last = grid.side - 1;
  const std::uint32_t first = patch_spare(grid.side);
  double deepest = 0.0;
  glm::dvec2 edge(0.0);  // m: the largest depth at the edges that x and y reach
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i) {
      if ((cells[j] >> i & 1U) == 0) {
        continue;
      }
      const double depth = grid.cells[j * grid.side + i].depth;
      deepest = std::max(deepest, depth);
      edge.x = i <= first || i == last ? std::max(edge.x, depth) : edge.x;
      edge.y = j == 0 || j == last ? std::max(edge.y, depth) : edge.y;
    }
  }
  const auto growth = [&](double depth) {
    if (depth <= little * deepest) {
      return 1.0;
    }
    const double fall = std::max(1.0 - depth / deepest, 0.0);
    return std::clamp(kGridMargin / std::sqrt(fall), kLeastGrowth, kMostGrowth);
  };
  return {growth(edge.x), growth(edge.y)};
}

void include_overlap(const Grid& grid, const RegionPoints& contact, const glm::dvec2& growth,
                     double depth, PlaneBox& box) {
  const PlaneBox overlap = overlap_around(grid, contact, box, growth, depth).box;
  if (overlap.empty()) {
    return;
  }
  const PlaneBox may_be_loaded = widened(overlap, glm::dvec2(kLoadedOverlap));
  const glm::dvec2 cut(growth.x > 1.0 ? 1.0 : 0.0, growth.y > 1.0 ? 1.0 : 0.0);
  box.include(glm::mix(box.lowest, may_be_loaded.lowest, cut),
              glm::mix(box.highest, may_be_loaded.highest, cut));
}

double deepening(const State& state, std::uint32_t region) {
  const double depth = state.regions.at<Overlap>(region).largest_depth;
  return depth > 0.0 ? std::max(1.0 + way_into_body(state, region) / depth, 1.0) : 1.0;
}

bool has_grown(const PatchState& state) {
  return state.grown != 0 && state.depth <= kSlightlyDeeper * (state.depth - state.deepened);
}

void grow_with_depth(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  const double depth_before = context.state.regions.at<Overlap>(region).largest_depth;
  const double depth = largest_depth(grid);
  // By the cells' depths and by the tool's motion: where two regions become one, those change
  // without it; where the body gives way as a whole, its motion is not all that they change by.
  const double deeper =
      depth_before > 0.0 ? std::min(depth / depth_before, deepening(context.state, region)) : 1.0;
  if (deeper <= kSlightlyDeeper) {
    return;
  }
  PatchState& state = context.state.regions.at<PatchState>(region);
  // What is loaded lies within the overlap, and the grid holds all of that, as under a flat punch.
  if (state.cut == 0 && growth_at_edges(grid, covered_cells(grid), 0.0) == glm::dvec2(1.0)) {
    return;
  }
  const LoadedArea area = loaded_cells(grid, kMostly);
  if (area.box.end.x == 0) {
    return;
  }
  const PlaneBox loaded = extent_of(grid, area.box);
  if (state.cut == 0 && holds(grid, widened(loaded, glm::dvec2(deeper)))) {
    return;
  }
  const SeenOverlap overlap = whole_overlap(grid, contact, loaded, deeper, depth);
  const glm::dvec2 ratio = glm::pow(glm::dvec2(deeper), overlap.powers);
  PlaneBox wanted = widened(loaded, ratio);
  if (deeper > kMuchDeeper || state.cut != 0) {
    const PlaneBox of_overlap = widened(overlap.box, loaded_share(overlap.powers));
    wanted.include(of_overlap.lowest, of_overlap.highest);
  }
  wanted = {glm::min(loaded.lowest, glm::max(wanted.lowest, overlap.box.lowest)),
            glm::max(loaded.highest, glm::min(wanted.highest, overlap.box.highest))};
  if (!overlap.box.empty() && !holds(grid, wanted)) {
    const RegionFrame before = grid.frame;
    const GridLayout layout = layout_around(wanted, grid.side);
    shift_origin(grid, layout.shift);
    grid.frame.half_size = layout.half_size;
    const CellMove move = move_between(before, grid.frame, grid.side);
    move_cells(grid, context.patch, move, depth, 0.0);
    const glm::dvec2 middle = 0.5 * glm::dvec2(area.box.first + area.box.end - 1);
    grow_pressures(grid, context.patch, move, middle, ratio, deeper / std::max(ratio.x, ratio.y));
    state.moved = 1;
    state.resized = 1;
    state.grown = 1;
  }
  find_cells(grid, contact);
}

}  // namespace torsion::engine
