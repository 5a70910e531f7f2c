#include "systems/patch/grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/growth.hpp"
#include "systems/patch/loaded_cells.hpp"

namespace torsion::engine {
namespace {

constexpr double kSmallestFill =
    0.74;  // over a new grid's: below it the region is regridded, smaller
constexpr double kOtherShape = 1.25;         // of a doubling: so far cells may be from their shape
constexpr std::uint32_t kSettlingSteps = 8;  // on other axes
// Depth at a grid's edge, over the largest, from which more lies beyond than regridding around the
// loaded cells takes in: at the rim of a ball's contact it is a half.
constexpr double kDeep = 0.7;
// Times the depth of the last step: the forces of a contact that grows so fast tell too little of
// the next one to say what of that the grid changes (F ~ depth^(3/2): an extrapolation misses 3/4
// of the square of this growth, 0.2 %).
constexpr double kFast = 1.05;
constexpr double kSure = 1.3;  // over the point load's far field: what certainly touches

/// Includes the contact points outside of the grid that are deeper than the pressure can have
/// displaced the surface there.
void include_lobes(const Grid& grid, std::uint32_t region, const RegionPoints& contact,
                   CellBox& box) {
  const Model& model = grid.model;
  const State& state = grid.state;
  // The points are where the tool is now: of a ball the force will have grown as Hertz' does.
  const double force =
      std::pow(deepening(state, region), 1.5) * state.regions.at<RegionNormal>(region).force;
  const double modulus = model.bodies.at<Elasticity>(grid.identity.body).contact_modulus();
  const glm::dvec2 center(
      body_to_grid(grid.frame, state.regions.at<Contact>(region).equivalent_point));
  const RegionSupport& support = state.regions.at<RegionSupport>(region);
  const CellFinder finder = finder_of(grid);
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    if (point.cluster != contact.cluster) {
      continue;
    }
    const glm::dvec2 place = finder.place(point.position);
    if (std::abs(place.x) < grid.frame.half_size.x && std::abs(place.y) < grid.frame.half_size.y) {
      continue;
    }
    const double distance = glm::length(place - center);
    // Points are found against the rest shape: the depth by which the whole body has sunk is no
    // overlap.
    const double sunk = -glm::dot(
        grid.frame.normal,
        support.translation + glm::cross(support.rotation, point.position - support.about));
    // Far field of a point load, F / (pi E* r): Johnson, Contact Mechanics, 1985, (3.22a).
    if ((point.depth - sunk) * std::numbers::pi * modulus * distance > kSure * force) {
      const glm::dvec2 at =
          (place / grid.frame.half_size + 1.0) * 0.5 * static_cast<double>(grid.side);
      const glm::ivec2 cell(glm::floor(at));
      box.first = glm::min(box.first, cell);
      box.end = glm::max(box.end, cell + 1);
    }
  }
}

/// Moves the grid by whole cells if that brings the box well into it.
/// @return false if it does not: nothing has changed
bool shift_frame(const Grid& grid, const CellBox& box, CellMove& move) {
  const double side = static_cast<double>(grid.side);
  const glm::dvec2 half = 0.5 * cell_size(grid) * glm::dvec2(box.end - box.first);
  const glm::dvec2 growth =
      tabulated_half_size(half / fill_of_new(grid.side)) / grid.frame.half_size;
  // With a free row or column on either side: otherwise the next step would regrid.
  const glm::ivec2 room = glm::ivec2(static_cast<int>(grid.side)) - (box.end - box.first) -
                          glm::ivec2(static_cast<int>(patch_spare(grid.side)), 0);
  if (growth.x != growth.y || growth.x <= 0.8 || growth.x >= 1.2 || std::min(room.x, room.y) < 2) {
    return false;
  }
  const glm::dvec2 off = patch_middle(grid.side) - 0.5 * side;
  move.origin = glm::round(0.5 * glm::dvec2(box.first + box.end) - off - 0.5 * side);
  shift_origin(grid, move.origin * cell_size(grid));
  return true;
}

/// How the loaded cells lie in their grid.
struct GridFit {
  double least = kMostly;    // share of a cell that is in contact, with which it counts
  CellBox box;               // of them, and of lobes outside of the grid
  bool has_lobes = false;    // there are some
  bool cut = false;          // the box comes to the grid's edge
  bool too_small = false;    // it leaves much of the grid empty
  bool grown = false;        // the grid grew with the depth, and another would fit better
  bool other_shape = false;  // cells of another shape would suit it
  bool has_rims = false;     // a long one with straight rims
  glm::dvec2 growth{1.0};    // of a grid that cuts off much (growth_at_edges)
  ContactAxes axes;

  /// Whether the grid follows the contact's axes, so that slipping cells keep their direction of
  /// slip.
  [[nodiscard]] bool takes_axes() const { return has_rims || axes.angle != 0.0; }
};

/// Whether the contact reaches two opposite edges of the grid, so that both may cut it off: over
/// most of the width, because two corners of a contact that lies askew reach the edges together.
bool fills_side(const Grid& grid, double least, const CellBox& box) {
  constexpr double kMost = 0.5;
  const auto side = static_cast<int>(grid.side);
  const auto spare = static_cast<int>(patch_spare(grid.side));
  const glm::ivec2 first = glm::clamp(box.first, glm::ivec2(0), glm::ivec2(side));
  const glm::ivec2 end = glm::clamp(box.end, glm::ivec2(0), glm::ivec2(side));
  const auto tractions = grid.state.cells.rows<CellTraction>(grid.identity.cells);
  const auto loaded = [&](int i, int j) {
    const auto cell = static_cast<std::size_t>(j * side + i);
    return is_loaded(tractions[cell], grid.cells[cell], least) ? 1 : 0;
  };
  glm::ivec2 lowest(0);   // cells in the first column and row
  glm::ivec2 highest(0);  // in the last ones
  for (int j = first.y; j < end.y; ++j) {
    lowest.x += loaded(spare, j);
    highest.x += loaded(side - 1, j);
  }
  for (int i = first.x; i < end.x; ++i) {
    lowest.y += loaded(i, 0);
    highest.y += loaded(i, side - 1);
  }
  const glm::dvec2 both(glm::min(lowest, highest));
  return both.x > kMost * (end.y - first.y) || both.y > kMost * (end.x - first.x);
}

/// Whether the loaded cells fill so much of their box along turned axes as those of a punch with
/// straight rims.
bool fill_their_box(const Grid& grid, double least, double loaded, double angle) {
  constexpr double kRectangular = 0.9;  // of an ellipse 0.79
  const PlaneBox box = extent_along(grid, least, angle);
  const glm::dvec2 size = box.highest - box.lowest;
  return loaded * cell_area(grid.frame, grid.side) > kRectangular * size.x * size.y;
}

GridFit fit_of(const Grid& grid, std::uint32_t region, const RegionPoints& contact) {
  GridFit fit;
  LoadedArea loaded = loaded_cells(grid, fit.least);
  if (loaded.box.end.x == 0) {
    // There is none: the contact is an edge or a corner, finer than the cells.
    fit.least = 0.0;
    loaded = loaded_cells(grid, fit.least);
  }
  fit.box = loaded.box;
  if (fit.box.end.x == 0) {
    return fit;
  }
  fit.cut = reaches_edge(grid, fit.box);
  if (!fit.cut) {
    // Only in this case: a contact that has outgrown its grid has points outside of it, and which
    // of them were found is chance.
    include_lobes(grid, region, contact, fit.box);
    fit.has_lobes = fit.box.first != loaded.box.first || fit.box.end != loaded.box.end;
    fit.cut = reaches_edge(grid, fit.box);
  }
  const glm::ivec2 cells = fit.box.end - fit.box.first;
  fit.too_small =
      std::max(cells.x, cells.y) <
      static_cast<int>(kSmallestFill * fill_of_new(grid.side) * static_cast<double>(grid.side));
  const glm::dvec2 size = cell_size(grid) * glm::dvec2(cells);
  const double ratio =
      std::clamp(std::log2(size.x / size.y), -1.0 * kMostAspect, 1.0 * kMostAspect);
  fit.other_shape = std::abs(ratio - table_aspect(grid.frame.half_size)) > kOtherShape;
  if (!fit.has_lobes) {
    fit.axes = contact_axes(grid, loaded.moments);
    fit.has_rims = fit.axes.is_long() && !(fit.cut && fills_side(grid, fit.least, fit.box)) &&
                   fill_their_box(grid, fit.least, loaded.moments.weight, fit.axes.angle);
    // Slightly better axes gain nothing for a contact whose pressure ends smoothly.
    const double enough = (fit.has_rims ? kAligned : 1.0) * fit.axes.allowance;
    if (std::abs(fit.axes.angle) <= enough) {
      fit.axes.angle = 0.0;
    }
  }
  const auto most = static_cast<int>(fill_of_new(grid.side) * grid.side);
  fit.grown = has_grown(grid.state.regions.at<PatchState>(region)) &&
              (fit.has_rims || std::max(cells.x, cells.y) < most);
  if (fit.cut && fit.axes.angle == 0.0 && !fit.has_rims) {
    fit.growth = growth_at_edges(grid, loaded.cells, kDeep);
  }
  return fit;
}

/// Places the grid along the loaded cells' axes and around them.
void lay_frame(const Grid& grid, const RegionPoints& contact, const GridFit& fit, double depth) {
  PlaneBox loaded = fit.axes.angle == 0.0 ? extent_of(grid, fit.box)
                                          : extent_along(grid, fit.least, fit.axes.angle);
  if (fit.growth != glm::dvec2(1.0)) {
    include_overlap(grid, contact, fit.growth, depth, loaded);
  }
  turn_axes(grid.frame, fit.axes.angle);
  const GridLayout layout = layout_around(loaded, grid.side);
  shift_origin(grid, layout.shift);
  grid.frame.half_size = layout.half_size;
  if (fit.has_rims) {
    lay_along_contact(grid, contact, depth, loaded.highest - loaded.lowest);
  }
}

/// Sticking cells follow the tool in this step already. If they followed a step later, they would
/// be at other depths in between, by a motion that nobody has done work for.
void extrapolate_carrier(State& state, std::uint32_t region) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const double share = state.regions.at<RegionFriction>(region).stick_share;
  const MotionOverBody motion = motion_over_body(state, region);
  // As a rigid body about the contact's middle, so that the place of the grid's origin does not
  // matter.
  const glm::dvec3 middle = state.regions.at<Contact>(region).equivalent_point;
  const glm::dvec3 shift = shift_at(motion, middle);
  const double turn = share * glm::dot(turn_of(motion), frame.normal);
  RegionCarrier& carrier = state.regions.at<RegionCarrier>(region);
  const glm::dvec3 arm = frame.origin + carrier.translation - middle;
  carrier.translation += share * (shift - frame.normal * glm::dot(shift, frame.normal)) +
                         (glm::angleAxis(turn, frame.normal) * arm - arm);
  carrier.rotation += frame.normal * turn;
}

}  // namespace

glm::dvec2 patch_middle(std::uint32_t side) {
  const double half = 0.5 * static_cast<double>(side);
  return {half + 0.5 * patch_spare(side), half};
}

glm::dvec2 middle_in_grid(std::uint32_t side) {
  return patch_middle(side) / static_cast<double>(side) * 2.0 - 1.0;
}

std::uint32_t patch_spare(std::uint32_t side) {
  constexpr std::uint32_t kCoarsest = 6;
  return side % 2 == 0 && side >= kCoarsest ? 1 : 0;
}

void regrid_around_loaded(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  const GridFit fit = fit_of(grid, region, contact);
  PatchState& state = context.state.regions.at<PatchState>(region);
  if (has_grown(state)) {
    state.grown = 0;
  }
  state.cut = fit.cut ? 1 : 0;
  if (fit.box.end.x == 0 ||
      !(fit.cut || fit.too_small || fit.grown || fit.other_shape || fit.axes.is_askew())) {
    return;
  }
  const double depth = context.state.regions.at<Overlap>(region).largest_depth;
  CellMove move;
  if (fit.growth != glm::dvec2(1.0) || fit.axes.is_askew() || fit.other_shape || fit.grown ||
      !shift_frame(grid, fit.box, move)) {
    const RegionFrame before = grid.frame;
    lay_frame(grid, contact, fit, depth);
    move = move_between(before, grid.frame, grid.side);
  }
  const double reach = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  move_cells(grid, context.patch, move, depth, fit.takes_axes() ? reach : 0.0);
  std::uint32_t& event = context.state.regions.at<RegionWrench>(region).event_now;
  if (event == 0 && !move.keeps_cells() && deepening(context.state, region) < kFast) {
    event = static_cast<std::uint32_t>(RegionEvent::kRegridded);
  }
  state.moved = 1;
  state.resized = move.keeps_cells() ? 0 : 1;
  if (!move.keeps_cells() && fit.takes_axes()) {
    state.settling = kSettlingSteps;
  }
  state.slide = state.slide * move.turn;
}

void follow_patch(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  State& state = context.state;
  if (state.regions.at<RegionNormal>(region).force <= 0.0) {
    // The region has nothing to keep, and its grid may lie beside the points, where it would stay.
    // Without points it is where the tool has last been.
    state.patch_cells.zero(state.regions.at<RegionIdentity>(region).cells);
    state.regions.at<PatchState>(region) = PatchState{};
    if (contact.cluster != kNoRow) {
      place_new_grid(context, region, contact);
    }
    return;
  }
  regrid_around_loaded(context, region, contact);
  turn_normal_to(state.regions.at<RegionFrame>(region),
                 state.regions.at<Overlap>(region).mean_normal);
}

void find_patch_cells(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  const PatchState& state = context.state.regions.at<PatchState>(region);
  if (state.started == 0 && contact.cluster != kNoRow) {
    center_patch(grid, contact, deepest_of_cluster(grid, contact).depth);
    return;
  }
  extrapolate_carrier(context.state, region);
  find_cells(grid, contact);
  grow_with_depth(context, region, contact);
  if (state.resized != 0) {
    look_along_normal(grid, contact);
  }
}

}  // namespace torsion::engine
