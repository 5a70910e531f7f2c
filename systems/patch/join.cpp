#include "systems/patch/join.hpp"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/energy.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/layout.hpp"
#include "systems/patch/resampling.hpp"

namespace torsion {
namespace {

/// Takes in the loaded cells of a region, as seen in the grid of `frame`.
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

/// Whether a box lies in the grid with a free row and column on either side.
bool holds(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  const glm::dvec2 spare(patch_spare(grid.side) * cell.x, 0.0);
  return glm::all(glm::greaterThan(box.lowest, cell + spare - grid.frame.half_size)) &&
         glm::all(glm::lessThan(box.highest, grid.frame.half_size - cell));
}

/// Whether a region has tractions that are worth keeping.
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
  // All are displaced by the others' tractions, too, from now on: they are held where that is.
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

}  // namespace torsion
