#include <algorithm>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/energy.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/loaded_cells.hpp"
#include "systems/patch/region.hpp"

namespace torsion::engine {
namespace {

void copy_cells(State& state, Range from, Range to) {
  const PatchRows theirs = patch_rows(state, from);
  const PatchRows mine = patch_rows(state, to);
  std::ranges::copy(state.cells.rows<CellGeometry>(from),
                    state.cells.rows<CellGeometry>(to).begin());
  std::ranges::copy(theirs.tractions, mine.tractions.begin());
}

template <class Component>
void copy_component(State& state, std::uint32_t from, std::uint32_t region) {
  state.regions.at<Component>(region) = state.regions.at<Component>(from);
}

/// Releases the cells that are not in the region's contact.
/// @return the pressure that remains, Pa, summed over the cells
double keep_covered(State& state, std::uint32_t region) {
  const PatchRows rows = patch_rows(state, state.regions.at<RegionIdentity>(region).cells);
  double sum = 0.0;
  for (std::size_t cell = 0; cell < rows.tractions.size(); ++cell) {
    if (rows.geometry[cell].coverage <= 0.0) {
      rows.tractions[cell] = CellTraction{};
    }
    sum += rows.tractions[cell].pressure;
  }
  return sum;
}

/// Cells that are equally near to both regions' contacts count half in each.
void halve_shared(State& state, std::uint32_t from, std::uint32_t region) {
  const PatchRows theirs = patch_rows(state, state.regions.at<RegionIdentity>(from).cells);
  const PatchRows mine = patch_rows(state, state.regions.at<RegionIdentity>(region).cells);
  for (std::size_t cell = 0; cell < mine.tractions.size(); ++cell) {
    if (theirs.geometry[cell].coverage > 0.0 && mine.geometry[cell].coverage > 0.0) {
      for (CellTraction* const each : {&theirs.tractions[cell], &mine.tractions[cell]}) {
        each->pressure *= 0.5;
        each->traction *= 0.5;
      }
    }
  }
}

/// The region that was copied; its row may have changed since.
std::uint32_t copied_from(const State& state, const PatchState& copy) {
  const auto regions = state.regions.column<RegionIdentity>();
  const auto found = std::ranges::find(
      regions, copy.copy_of - 1, [](const RegionIdentity& region) { return block_of(region); });
  TORSION_ASSERT(found != regions.end());
  return static_cast<std::uint32_t>(found - regions.begin());
}

/// Regrids around the remaining cells in this step: in the next it would be a second event.
void regrid_around_rest(StepContext& context, std::uint32_t region) {
  const Grid grid = grid_of(context, region);
  const RegionPoints& contact = context.scratch.region_points[block_of(grid.identity)];
  regrid_around_loaded(context, region, contact);
  find_cells(grid, contact);
  context.state.regions.at<Overlap>(region) = summarize_cells(grid);
  // The cells are held at the displacements that they will have without the other region's
  // tractions.
  std::ranges::fill(patch_rows(context.state, grid.identity.cells).surface.known, 0.0);
}

void share_out(StepContext& context, std::uint32_t from, std::uint32_t region) {
  const Model& model = context.model;
  State& state = context.state;
  halve_shared(state, from, region);
  const double left = keep_covered(state, from);
  const double taken = keep_covered(state, region);
  regrid_around_rest(context, from);
  regrid_around_rest(context, region);
  const BodyLaw& body = body_law_of(model, state.regions.at<RegionIdentity>(from).body);
  if (body.split != nullptr) {
    body.split(model, state, from, region);
  }
  if (left + taken > 0.0) {
    split_energy(state, from, region, taken / (left + taken));
  }
  for (const std::uint32_t each : {from, region}) {
    PatchState& own = state.regions.at<PatchState>(each);
    own.moved = 1;
    own.resized = 1;
  }
}

}  // namespace

void copy_patch(State& state, std::uint32_t from, std::uint32_t region) {
  if (state.regions.at<PatchState>(from).started == 0) {
    return;
  }
  const Range cells = state.regions.at<RegionIdentity>(from).cells;
  copy_cells(state, cells, state.regions.at<RegionIdentity>(region).cells);
  copy_component<RegionFrame>(state, from, region);
  copy_component<RegionCarrier>(state, from, region);
  copy_component<Overlap>(state, from, region);
  copy_component<Contact>(state, from, region);
  copy_component<RegionMotion>(state, from, region);
  copy_component<RegionFriction>(state, from, region);
  copy_component<PatchState>(state, from, region);
  state.regions.at<PatchState>(region).copy_of = cells.first / cells.count + 1;
}

void share_out_patch(StepContext& context, std::uint32_t region) {
  PatchState& copy = context.state.regions.at<PatchState>(region);
  if (copy.copy_of != 0) {
    share_out(context, copied_from(context.state, copy), region);
    copy.copy_of = 0;
  }
}

namespace {

/// Extends a box by the loaded cells of a region, seen in the grid of `frame`.
void include_loaded(const Grid& of, const RegionFrame& frame, PlaneBox& box) {
  const auto tractions = of.state.cells.rows<CellTraction>(of.identity.cells);
  const glm::dvec2 half = cell_half_size(of);
  const glm::dvec2 along_x = glm::abs(glm::dvec2(
      body_to_grid_direction(frame, tangent_to_body(of.frame, glm::dvec2(half.x, 0.0)))));
  const glm::dvec2 along_y = glm::abs(glm::dvec2(
      body_to_grid_direction(frame, tangent_to_body(of.frame, glm::dvec2(0.0, half.y)))));
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < of.side; ++j) {
    for (std::uint32_t i = 0; i < of.side; ++i, ++cell) {
      if (tractions[cell].pressure > 0.0) {
        const glm::dvec3 center(cell_center(of.frame, of.side, i, j), 0.0);
        const glm::dvec2 at(body_to_grid(frame, grid_to_body(of.frame, center)));
        box.include(at - along_x - along_y, at + along_x + along_y);
      }
    }
  }
}

/// Whether a region has tractions worth keeping.
bool has_settled(const State& state, std::uint32_t region) {
  constexpr double kSolved = 0.1;  // PatchState::residual
  const PatchState& own = state.regions.at<PatchState>(region);
  return own.started != 0 && own.residual < kSolved;
}

}  // namespace

void join_patch(StepContext& context, std::uint32_t ended, std::uint32_t heir) {
  const Model& model = context.model;
  State& state = context.state;
  if (!has_settled(state, ended) || !has_settled(state, heir)) {
    return;
  }
  const Grid grid = grid_of(context, heir);
  const Grid other = grid_of(context, ended);
  PlaneBox box;
  include_loaded(grid, grid.frame, box);
  include_loaded(other, grid.frame, box);
  if (!box.empty() && !holds(grid, box)) {
    const RegionFrame before = grid.frame;
    const GridLayout layout = layout_around(box, grid.side);
    shift_origin(grid, layout.shift);
    grid.frame.half_size = layout.half_size;
    move_cells(grid, context.patch, move_between(before, grid.frame, grid.side),
               state.regions.at<Overlap>(heir).largest_depth, 0.0);
  }
  add_cells(grid, move_between(other.frame, grid.frame, grid.side),
            state.cells.rows<CellTraction>(other.identity.cells));
  // From now on all cells are displaced by the other region's tractions, too, and are held there.
  std::ranges::fill(patch_rows(state, grid.identity.cells).surface.known, 0.0);
  const RegionSupport support = state.regions.at<RegionSupport>(heir);
  const BodyLaw& body = body_law_of(model, state.regions.at<RegionIdentity>(heir).body);
  if (body.join != nullptr) {
    body.join(model, state, ended, heir);
  }
  retell_others(state, heir, support);
  RegionMotion& motion = state.regions.at<RegionMotion>(heir);
  const RegionMotion& of_ended = state.regions.at<RegionMotion>(ended);
  motion.largest_turn = std::max(motion.largest_turn, of_ended.largest_turn);
  motion.largest_rotation = std::max(motion.largest_rotation, of_ended.largest_rotation);
  PatchState& own = state.regions.at<PatchState>(heir);
  own.moved = 1;
  own.resized = 1;
}

}  // namespace torsion::engine
